// Ctrl-C: nothing half-written, exit 130.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "core/file.h"
#include "integration/program.h"
#include "support/places.h"

namespace patina::test {
namespace {

TEST(Interrupt, CancelsAndLeavesTheOutputAsItWas) {
  const ScratchFolder folder;
  const std::string mesh = folder / "sphere.ply";
  ASSERT_EQ(run({"model", "sphere", "-o", mesh, "--frequency", "224"}).exit, 0);
  const std::string output = folder.write("field.vti", "what stood here");
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
  EXPECT_EQ(readFile(output), "what stood here");
  EXPECT_LT(seconds, 20);
  std::size_t files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.path())) {
    (void)file;
    ++files;
  }
  EXPECT_EQ(files, 2u) << "a temporary file was left behind";
}

// As a shell starts what is in the background: SIGINT ignored. It comes while libraries are set up.
TEST(Interrupt, IsNotLostBeforeMain) {
  const ScratchFolder folder;
  const std::string mesh = folder / "sphere.ply";
  ASSERT_EQ(run({"model", "sphere", "-o", mesh}).exit, 0);
  const auto usual = std::signal(SIGINT, SIG_IGN);
  Outcome outcome;
  {
    const Environment early(
        {{"LD_PRELOAD", programFolder() / "fault_shim.so"}, {"PATINA_FAULT_EARLY", "1"}});
    outcome = run({"field", mesh, "-o", folder / "field.vti"});
  }
  std::signal(SIGINT, usual);
  EXPECT_EQ(outcome.exit, 130);
  EXPECT_EQ(outcome.err, "patina: cancelled\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "field.vti"));
}

TEST(Interrupt, EndsTheLatencyTest) {
  Running latency({"latency-test", "--seconds", "100"}, programPath());
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  latency.signal(SIGINT);
  EXPECT_EQ(latency.wait().exit, 128 + SIGINT);
}

} // namespace
} // namespace patina::test
