// Outputs that are no plain files, or files that another program still needs.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fcntl.h>
#include <future>
#include <poll.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "integration/every_command.h"
#include "support/places.h"

namespace patina::test {
namespace {

namespace fs = std::filesystem;

class HostileOutput : public EveryCommand {
 protected:
  void expectUntouched(const CommandLine& line, const std::string& output,
                       const std::vector<std::string>& parts) const {
    expectUntouchedIn(line, output, output, parts);
  }

  void expectUntouchedIn(const CommandLine& line, const std::string& output,
                         const std::string& file, const std::vector<std::string>& parts) const {
    const std::string before = readFile(file);
    expectOneLineError(run(line.to(output)), parts);
    EXPECT_EQ(readFile(file), before) << line.name;
  }

  // Returns the names in a folder, with sizes.
  static std::string names(const std::string& in) {
    std::vector<std::string> all;
    for (const auto& item : fs::directory_iterator(in))
      all.push_back(item.path().filename().string() +
                    (item.is_regular_file() ? " " + std::to_string(item.file_size()) : ""));
    std::sort(all.begin(), all.end());
    std::string text;
    for (const std::string& name : all) text += name + "\n";
    return text;
  }

  void expectWrittenThrough(const CommandLine& line) const {
    const std::string link = folder / ("link" + line.extension),
                      end = folder / ("end" + line.extension);
    fs::create_symlink(fs::path(end).filename(), link);
    for (int round = 0; round < 2; ++round) { // first a link to nothing, then to a file
      const Outcome outcome = run(line.to(link));
      EXPECT_LE(outcome.exit, 1) << line.name << outcome.err; // 1: it did not converge
      EXPECT_TRUE(fs::is_symlink(link)) << line.name;
      EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(end))) << line.name;
      EXPECT_GT(fs::file_size(end), 10u);
    }
    fs::remove(link);
    fs::remove(end);
  }

  void expectOthersRefused(const CommandLine& line) const {
    const std::string foreign =
        line.extension == ".json" ? "x [m],y [m]\n1,2\n" : "{\"of\": \"another kind\"}\n";
    const std::string file = folder / ("file" + line.extension),
                      place = folder / ("folder" + line.extension);
    fs::create_directory(place);
    expectOneLineError(run(line.to(place)), {"it is a folder"});
    ASSERT_LE(run(line.to(file)).exit, 1) << line.name;
    fs::permissions(file, fs::perms::owner_read);
    expectUntouched(line, file, {"it is read-only"});
    fs::permissions(file, fs::perms::owner_all);
    auto keeping = line;
    keeping.words.push_back("--no-clobber");
    expectUntouched(keeping, file, {"--no-clobber"});
    folder.write("file" + line.extension, foreign);
    expectUntouched(line, file, {"not overwritten"});
    folder.write("file" + line.extension, "Dear reader, this is prose.\nIt has two lines.\n");
    expectUntouched(line, file, {"not overwritten"});
    folder.write("file" + line.extension, ""); // nothing is lost
    EXPECT_LE(run(line.to(file)).exit, 1) << line.name;
    fs::remove(place);
    fs::remove(file);
    fs::create_symlink(fs::path(file).filename(), file); // to itself
    expectOneLineError(run(line.to(file)), {"symbolic links"});
    fs::remove(file);
  }
};

TEST_F(HostileOutput, LinksAreWrittenThrough) {
  for (const CommandLine& line : fileCommands()) expectWrittenThrough(line);
}

TEST_F(HostileOutput, PipeGetsTheSameBytesAsAFile) {
  for (const CommandLine& line : fileCommands()) {
    const std::string pipe = folder / ("pipe" + line.extension),
                      file = folder / ("file" + line.extension);
    ASSERT_EQ(run(line.to(file)).exit, 0) << line.name;
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    auto reader = std::async(std::launch::async, [&] { return readFile(pipe); });
    EXPECT_EQ(run(line.to(pipe)).exit, 0) << line.name;
    const std::string got = reader.get();
    EXPECT_TRUE(fs::is_fifo(pipe)) << line.name;
    EXPECT_EQ(firstLine(file), got.substr(0, got.find('\n'))) << line.name;
    if (line.name != "feel") { // its steps are timed
      EXPECT_EQ(readFile(file), got) << line.name;
    }
    fs::remove(pipe);
  }
}

// A pseudo-terminal of the test, by a link: no device of the system is at risk.
TEST_F(HostileOutput, DeviceIsWrittenAndStaysADevice) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(grantpt(terminal), 0);
  ASSERT_EQ(unlockpt(terminal), 0);
  const std::string device = ptsname(terminal);
  const int held = open(device.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC); // keeps it open
  ASSERT_GE(held, 0);
  std::atomic<bool> over{false};
  std::atomic<std::size_t> bytes{0};
  std::thread reader([&] {
    char buffer[4096];
    for (pollfd wait{terminal, POLLIN, 0}; !over;)
      if (poll(&wait, 1, 20) > 0) {
        const ssize_t got = read(terminal, buffer, sizeof buffer);
        bytes += got > 0 ? static_cast<std::size_t>(got) : 0;
      }
  });
  for (const CommandLine& line : fileCommands()) {
    const std::string link = folder / ("device" + line.extension);
    fs::remove(link);
    fs::create_symlink(device, link);
    bytes = 0;
    EXPECT_EQ(run(line.to(link)).exit, 0) << line.name;
    EXPECT_TRUE(fs::is_symlink(link)) << line.name;
    EXPECT_TRUE(fs::is_character_file(device)) << line.name;
    for (int time = 0; time < 500 && bytes <= 10; ++time) // the reader may need time
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_GT(bytes, 10u) << line.name;
  }
  over = true;
  reader.join();
  close(held);
  close(terminal);
}

TEST_F(HostileOutput, FoldersReadOnlyAndForeignFilesAreRefused) {
  for (const CommandLine& line : fileCommands()) expectOthersRefused(line);
}

TEST_F(HostileOutput, FolderOutputReplacesNoOtherKind) {
  for (const CommandLine& line : folderCommands()) {
    const std::string file = folder.write("file.txt", "prose");
    expectUntouched(line, file, {"file.txt"});
    const std::string pipe = folder / ("pipe-" + line.name);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    expectOneLineError(run(line.to(pipe)), {"pipe-"});
    EXPECT_TRUE(fs::is_fifo(pipe));
    if (line.writes != Writes::workspace) continue;
    fs::create_directory(folder / ("full-" + line.name));
    const std::string within = folder.write("full-" + line.name + "/letter.txt", "prose");
    expectOneLineError(run(line.to(folder / ("full-" + line.name))), {"not a workspace"});
    EXPECT_EQ(readFile(within), "prose");
  }
}

TEST_F(HostileOutput, ExportReplacesItsOwnFilesOnly) {
  const std::string out = folder / "out";
  ASSERT_EQ(run({"export", workspace, "-o", out}).exit, 0);
  const std::string before = fingerprint(out);
  ASSERT_EQ(run({"export", workspace, "-o", out}).exit, 0);
  EXPECT_EQ(fingerprint(out), before);
  const std::string tip = folder.write("out/forces.csv", "t [s],x [m],y [m],z [m]\n0,0,0,1\n");
  expectOneLineError(run({"export", workspace, "-o", out, "--path", tip}),
                     {"forces.csv", "an input of this command"});
  std::filesystem::remove(tip);
  folder.write("out/vertices.csv", "{\"a\": 1}");
  const std::string foreign = fingerprint(out);
  expectOneLineError(run({"export", workspace, "-o", out}), {"vertices.csv", "a JSON file"});
  EXPECT_EQ(fingerprint(out), foreign);
}

TEST_F(HostileOutput, ScanReplacesNoForeignFiles) {
  makeScan();
  for (const CommandLine& line : scanFileCommands()) {
    expectWrittenThrough(line);
    expectOthersRefused(line);
  }
  for (const CommandLine& line : scanFolderCommands()) {
    expectUntouched(line, folder.write("file.txt", "prose"), {"file.txt"});
    const std::string pipe = folder / ("pipe-" + line.name);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    expectOneLineError(run(line.to(pipe)), {"pipe-"});
    EXPECT_TRUE(fs::is_fifo(pipe));
  }
}

TEST_F(HostileOutput, LinkOfAnotherUserInAStickyFolderIsRefused) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a link away";
  constexpr uid_t kOther = 65533;
  const fs::path shared = folder / "shared";
  fs::create_directory(shared);
  ASSERT_EQ(chmod(shared.c_str(), 01777), 0);
  const auto expectRefused = [&](const CommandLine& line, const std::string& target) {
    const std::string link = shared / ("link" + line.extension);
    const std::string before = fs::is_directory(target) ? names(target) : "";
    fs::create_symlink(target, link);
    ASSERT_EQ(lchown(link.c_str(), kOther, kOther), 0);
    expectOneLineError(run(line.to(link)), {link, "is a link of another user"});
    EXPECT_EQ(fs::is_directory(target) ? names(target) : "", before) << line.name;
    fs::remove(link);
  };
  const std::string empty = folder / "empty";
  fs::create_directory(empty);
  for (const CommandLine& line : fileCommands()) {
    expectRefused(line, folder / ("end" + line.extension));
    EXPECT_FALSE(fs::exists(folder / ("end" + line.extension))) << line.name;
  }
  for (const CommandLine& line : folderCommands()) expectRefused(line, empty);
  expectRefused({"paint", {"paint", "OUT", "--strokes", strokes, "-o", "OUT"}, ""}, workspace);
}

TEST_F(HostileOutput, PluginThatOthersCanChangeIsRefusedAlsoForAUserWhoIsNotRoot) {
  const ScratchFolder open; // in /tmp
  const fs::path plugin = open.path() / "patina_device_open.so";
  fs::copy_file(programFolder() / "patina_device_example.so", plugin);
  const Environment searched({{"PATINA_DEVICES", open.path().string()}});
  const auto listed = [] {
    const Json report = runJson({"devices"});
    for (const Json& one : report.at("devices").asArray())
      if (one.at("name").asString() == "open") return one.at("advice").asString();
    return std::string("used");
  };
  if (geteuid() == 0) { // /tmp is no system folder
    EXPECT_NE(listed().find("is not trusted: "), std::string::npos);
  } else {
    EXPECT_EQ(listed(), "used");
    ASSERT_EQ(chmod(plugin.c_str(), 0757), 0);
    EXPECT_NE(listed().find("is not trusted: others may write into "), std::string::npos);
  }
  if (geteuid() != 0) return;
  constexpr uid_t kUser = 65533;
  const auto asUser = [&] {
    return Running({"--reuid=65533", "--regid=65533", "--clear-groups", programPath().string(),
                    "devices"},
                   "/usr/bin/setpriv")
        .wait();
  };
  ASSERT_EQ(chmod(open.path().c_str(), 0755), 0);
  ASSERT_EQ(chown(open.path().c_str(), kUser, kUser), 0);
  ASSERT_EQ(chown(plugin.c_str(), kUser, kUser), 0);
  EXPECT_NE(asUser().out.find("Example hand"), std::string::npos);
  ASSERT_EQ(chmod(plugin.c_str(), 0757), 0);
  const Outcome outcome = asUser();
  EXPECT_EQ(outcome.exit, 0);
  const std::size_t at = outcome.out.find(plugin.string() + ": is not trusted: others may write");
  EXPECT_NE(at, std::string::npos) << outcome.out;
}

// A scan in the output folder is replaced by a scan, if each file has the expected kind, or not at
// all.
TEST_F(HostileOutput, SimulatedScanReplacesFilesOfTheSameKindOnly) {
  const std::string out = folder / "out";
  const CommandLine line{
      "simulate-scan", {"simulate-scan", box, "-o", "OUT", "--seconds", "1"}, ""};
  ASSERT_EQ(run(line.to(out)).exit, 0);
  fs::rename(out + "/truth.json", folder / "elsewhere.json");
  fs::create_symlink(folder / "elsewhere.json", out + "/truth.json");
  ASSERT_EQ(run(line.to(out)).exit, 0);
  EXPECT_TRUE(fs::is_symlink(out + "/truth.json"));
  const auto refused = [&](const std::string& name, const char* why, const auto& spoil) {
    fs::rename(out + "/" + name, folder / "kept");
    spoil(out + "/" + name);
    const std::string before = names(out);
    expectOneLineError(run(line.to(out)), {name, why});
    EXPECT_EQ(names(out), before);
    fs::remove(out + "/" + name);
    fs::rename(folder / "kept", out + "/" + name);
  };
  const auto holding = [&](const char* text) {
    return [text](const std::string& path) { writeFileAtomically(path, text); };
  };
  refused("mesh.obj", "not overwritten", holding("Dear reader, this is prose.\n"));
  refused("truth.csv", "not overwritten", holding("{}\n"));
  refused("poses.tum", "not overwritten", holding("Dear reader, this is prose.\n"));
  refused("rig.json", "read-only", [](const std::string& path) {
    writeFileAtomically(path, "{}\n");
    fs::permissions(path, fs::perms::owner_read);
  });
  refused("probe.csv", "folder", [](const std::string& path) { fs::create_directory(path); });
  refused("truth.json", "pipes or devices",
          [](const std::string& path) { mkfifo(path.c_str(), 0600); });
  refused("truth.csv", "pipes or devices",
          [](const std::string& path) { fs::create_symlink("/dev/null", path); });
}

TEST_F(HostileOutput, RecordingAndDemoKeepExistingFiles) {
  makeScan();
  const CommandLine record = scanFolderCommands()[1];
  const std::string out = folder / "out";
  fs::create_directory(out);
  for (const char* name : {"frames.csv", "poses.tum", "probe.csv", "frames"}) {
    fs::create_symlink(folder / "nowhere", out + "/" + name); // a link to nothing
    expectOneLineError(run(record.to(out)), {"holds a scan already"});
    fs::remove(out + "/" + name);
  }
  folder.write("out/rig.json", "{\"of\": \"another\"}\n");
  expectUntouchedIn(record, out, out + "/rig.json", {"rig.json", "another"});
  fs::remove(out + "/rig.json");
  folder.write("out/report.json", "Dear reader, this is prose.\n");
  expectUntouchedIn({"demo", {"demo", "-o", "OUT"}, ""}, out, out + "/report.json",
                    {"report.json", "not overwritten"});
  EXPECT_FALSE(fs::exists(folder / "nowhere"));
}

TEST_F(HostileOutput, KeepsForeignRules) {
  const std::string rules = folder.write("70-patina.rules", "# of somebody\n");
  expectOneLineError(run({"devices", "--install-udev", folder.path().string()}), {"other rules"});
  EXPECT_EQ(readFile(rules), "# of somebody\n");
  fs::remove(rules);
  for (int round = 0; round < 2; ++round)
    EXPECT_EQ(run({"devices", "--install-udev", folder.path().string()}).exit, 0);
}

TEST_F(HostileOutput, DashMeansStandardStream) {
  const Outcome table = run({"sample", box, "--points", points, "-o", "-"});
  EXPECT_EQ(table.exit, 0);
  EXPECT_TRUE(table.out.starts_with("x [m],y [m]")) << table.out;
  EXPECT_NE(table.err.find("in the band"), std::string::npos) << "the report goes elsewhere";
  const Outcome mesh = run({"model", "box", "-o", "-", "--unit", "mm"});
  EXPECT_EQ(mesh.out, readFile(box));
  const Outcome piped =
      Running({"-c", "\"$0\" model box -o - 2>/dev/null | \"$0\" sample - --points \"$1\" -o -",
               programPath().string(), points},
              "/bin/bash")
          .wait();
  EXPECT_EQ(piped.out, table.out) << piped.err;
  expectOneLineError(run({"sample", "-", "--points", "-", "-o", folder / "x.csv"}),
                     {"standard input is one"});
  const Outcome json =
      run({"sample", folder / "none.ply", "--points", points, "-o", folder / "x.csv", "--json"});
  EXPECT_EQ(json.exit, 2);
  const Json error = parseJson(json.out, "stdout").at("error");
  EXPECT_EQ(error.at("file").asString(), folder / "none.ply");
  EXPECT_EQ(json.err, "patina: " + error.at("message").asString() + "\n");
}

TEST_F(HostileOutput, PipeWithoutAReaderIsAnErrorWithoutWaiting) {
  const std::string in = folder / "in.csv", out = folder / "out.csv";
  ASSERT_EQ(mkfifo(in.c_str(), 0600) + mkfifo(out.c_str(), 0600), 0);
  Running reader({"sample", box, "--points", in, "-o", folder / "x.csv"}, programPath()),
      writer({"sample", box, "--points", points, "-o", out}, programPath());
  expectOneLineError(reader.wait(), {"in.csv", "without a writer"});
  expectOneLineError(writer.wait(), {"out.csv", "without a reader"});
}

} // namespace
} // namespace patina::test
