// Ctrl-C leaves nothing half-written, exit 130.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "core/file.h"
#include "integration/every_command.h"
#include "support/longer.h"
#include "support/places.h"

namespace patina::test {
namespace {

TEST(Interrupt, CancelsAndKeepsTheOldOutput) {
  const ScratchFolder folder;
  const std::string mesh = folder / "sphere.ply";
  ASSERT_EQ(run({"model", "sphere", "-o", mesh, "--frequency", "224"}).exit, 0);
  const std::string output = folder.write("field.vti", ""); // may be replaced
  // A million triangles at this resolution take many times longer than the wait.
  Running field({"field", mesh, "-o", output, "--resolution", "1200"}, programPath());
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ASSERT_FALSE(field.finished()) << "too quick to be interrupted";
  const auto begin = std::chrono::steady_clock::now();
  field.signal(SIGINT);
  const Outcome outcome = field.wait();
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_EQ(outcome.exit, 130);
  EXPECT_EQ(outcome.err, "patina: cancelled\n");
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(readFile(output), "");
  EXPECT_LT(seconds, 5);
  std::size_t files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.path())) {
    (void)file;
    ++files;
  }
  EXPECT_EQ(files, 2u) << "a temporary file was left behind";
}

// A supervisor or a closed terminal ends the program like this.
TEST(Interrupt, LeavesNothingForOtherSignals) {
  const ScratchFolder folder;
  const std::string mesh = folder / "sphere.ply";
  ASSERT_EQ(run({"model", "sphere", "-o", mesh, "--frequency", "200"}).exit, 0);
  for (const int number : {SIGTERM, SIGHUP}) {
    Running field({"field", mesh, "-o", folder / "field.vti", "--resolution", "1200"},
                  programPath());
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    ASSERT_FALSE(field.finished()) << "too quick to be interrupted";
    field.signal(number);
    field.signal(number); // a second signal changes nothing
    EXPECT_EQ(field.wait().exit, 130);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  }
}

// A shell starts background jobs with SIGINT ignored. The signal comes while libraries are loaded.
TEST(Interrupt, IsNotLostBeforeMain) {
  const ScratchFolder folder;
  const std::string mesh = folder / "sphere.ply";
  ASSERT_EQ(run({"model", "sphere", "-o", mesh}).exit, 0);
  const auto usual = std::signal(SIGINT, SIG_IGN);
  Outcome outcome;
  {
    const Environment early(
        {{"LD_PRELOAD", preloadable("fault_shim.so")}, {"PATINA_FAULT_EARLY", "1"}});
    outcome = run({"field", mesh, "-o", folder / "field.vti"});
  }
  std::signal(SIGINT, usual);
  EXPECT_EQ(outcome.exit, 130);
  EXPECT_EQ(outcome.err, "patina: cancelled\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "field.vti"));
}

// Ctrl-C at any time of every command: it ends at once, with 130 or as if undisturbed, and no
// half-written output stays.
class AnyTime : public EveryCommand {
 protected:
  // Each command has so much to do that the signal meets it at work.
  std::vector<CommandLine> busyCommands() {
    const std::string ball = folder / "ball.ply";
    EXPECT_EQ(run({"model", "sphere", "-o", ball, "--frequency", "100"}).exit, 0);
    std::string many = "x [m],y [m],z [m]\n", path = "t [s],x [m],y [m],z [m]\n",
                heights = "along [m],height [m]\n";
    for (long i = 0; i < longer(100000); ++i) {
      many += "0,0,0.0" + std::to_string(10000 + i % 50000) + "\n";
      path += std::to_string(i) + "e-3,0,0,0.0" + std::to_string(45000 + i % 6000) + "\n";
      heights += std::to_string(i) + "e-5," + std::to_string(i * i % 17) + "e-6\n";
    }
    const std::string points_of = folder.write("many.csv", many),
                      path_of = folder.write("path.csv", path),
                      heights_of = folder.write("waves.csv", heights);
    std::vector<CommandLine> lines = {
        {"model", {"model", "sphere", "-o", "OUT", "--frequency", "500"}, ".ply"},
        {"field", {"field", ball, "-o", "OUT", "--resolution", "500"}, ".vti"},
        {"sample", {"sample", ball, "--points", points_of, "-o", "OUT"}, ".csv"},
        {"feel", {"feel", ball, "--path", path_of, "-o", "OUT"}, ".csv"},
        {"simulate", {"simulate", "--plane", "--seconds", "1000", "-o", "OUT"}, ".csv"},
        {"emboss", {"emboss", ball, "-o", "OUT", "--resolution", "400"}, ".stl"},
        {"export", {"export", ball, "-o", "OUT", "--resolution", "300"}, "", Writes::folder},
        {"scene", {"scene", "-o", "OUT", "--add", ball}, "", Writes::workspace},
        {"paint", {"paint", workspace, "--strokes", strokes, "-o", "OUT"}, "", Writes::workspace},
        {"study", {"study", "all", "-o", "OUT"}, "", Writes::folder},
        {"info", {"info", ball, "--resolution", "400"}, ""},
        {"undo", {"undo", workspace, "--list"}, ""},
        {"redo", {"redo", workspace}, ""},
        {"man", {"man", "-o", "OUT"}, "", Writes::folder},
        {"help", {"help", "feel"}, ""},
        {"completion", {"completion", "zsh"}, ""},
        {"devices", {"devices", "--diagnose"}, ""},
        {"latency-test", {"latency-test"}, ""},
        {"latency-test --emulated-falcon", {"latency-test", "--emulated-falcon"}, ""}};
    if (std::getenv("DISPLAY"))
      lines.push_back({"render", {"render", ball, "-o", "OUT", "--resolution", "400"}, ".png"});
    makeScan();
    for (CommandLine line : scanFileCommands()) lines.push_back(std::move(line));
    for (CommandLine line : scanFolderCommands()) lines.push_back(std::move(line));
    lines.push_back({"simulate-scan --frames",
                     {"simulate-scan", ball, "-o", "OUT", "--frames"},
                     "",
                     Writes::folder});
    lines.push_back({"fit-texture", {"fit-texture", heights_of, "-o", "OUT"}, ".json"});
    lines.push_back({"demo", {"demo", "-o", "OUT"}, "", Writes::folder});
    lines.push_back({"simulate-device", {"simulate-device", "probe", "--link", "OUT"}, ".tty"});
    return lines;
  }
};

TEST_F(AnyTime, EveryCommandEndsAtOnceWithoutPartialOutput) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point since) {
    return std::chrono::duration<double>(Clock::now() - since).count();
  };
  const std::vector<CommandLine> lines = busyCommands();
  const auto begun = Clock::now();
  for (int i = 0; i < 3; ++i) run({"--version"});
  const double limit = 0.5 + 4 * seconds(begun) / 3; // a busy machine starts slowly, too
  const long rounds = longer(1) > 1 ? 20 : 1;
  std::mt19937 random(5);
  double slowest_of_all = 0;
  for (const CommandLine& line : lines) {
    // A slow run is repeated up to five times, because another program may have delayed it.
    int slow = 0;
    double slowest = 0;
    for (long round = 0; round < rounds + slow; ++round) {
      const std::string out = folder / ("out" + line.extension);
      std::filesystem::remove_all(out);
      const std::vector<std::string> before = names();
      Running running(line.to(out), programPath());
      std::this_thread::sleep_for(std::chrono::milliseconds(random() % (rounds > 1 ? 2500 : 400)));
      const auto since = Clock::now();
      running.signal(SIGINT);
      const Outcome outcome = running.wait();
      const double took = seconds(since);
      if (took < limit)
        slowest = std::max(slowest, took);
      else
        EXPECT_LE(++slow, 5) << line.name << " took " << took << " s of " << limit;
      if (slow > 5) break;
      std::vector<std::string> left = names();
      if (outcome.exit <= 1) { // it had finished, or a recording ended normally
        std::erase(left, std::filesystem::path(out).filename().string());
        if (std::filesystem::is_directory(out)) {
          for (const auto& item : std::filesystem::recursive_directory_iterator(out))
            EXPECT_FALSE(item.path().filename().string().starts_with(".")) << item.path();
        }
      } else {
        EXPECT_EQ(outcome.exit, 130) << line.name << outcome.err;
      }
      EXPECT_EQ(left, before) << line.name << " left something";
    }
    if (rounds > 1) std::printf("%s %.3f s, again %d\n", line.name.c_str(), slowest, slow);
    slowest_of_all = std::max(slowest_of_all, slowest);
  }
  std::printf("the slowest took %.3f s of %.3f\n", slowest_of_all, limit);
  EXPECT_EQ(run({"info", workspace}).exit, 0);
}

TEST(Interrupt, EndsTheLatencyTest) {
  Running latency({"latency-test", "--seconds", "100"}, programPath());
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  latency.signal(SIGINT);
  EXPECT_EQ(latency.wait().exit, 128 + SIGINT);
}

} // namespace
} // namespace patina::test
