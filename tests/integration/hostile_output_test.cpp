// Outputs that are no plain files, or files that somebody still needs.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <fcntl.h>
#include <future>
#include <poll.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "integration/every_command.h"

namespace patina::test {
namespace {

namespace fs = std::filesystem;

class HostileOutput : public EveryCommand {
 protected:
  void expectUntouched(const CommandLine& line, const std::string& output,
                       const std::vector<std::string>& parts) const {
    const std::string before = readFile(output);
    expectOneLineError(run(line.to(output)), parts);
    EXPECT_EQ(readFile(output), before) << line.name;
  }
};

TEST_F(HostileOutput, LinksAreWrittenThrough) {
  for (const CommandLine& line : fileCommands()) {
    const std::string link = folder / ("link" + line.extension),
                      end = folder / ("end" + line.extension);
    fs::create_symlink(fs::path(end).filename(), link);
    for (int round = 0; round < 2; ++round) { // to nothing, then to a file
      const Outcome outcome = run(line.to(link));
      EXPECT_EQ(outcome.exit, 0) << line.name << outcome.err;
      EXPECT_TRUE(fs::is_symlink(link)) << line.name;
      EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(end))) << line.name;
      EXPECT_GT(fs::file_size(end), 10u);
    }
    fs::remove(link);
    fs::remove(end);
  }
}

TEST_F(HostileOutput, APipeGetsWhatAFileWould) {
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

// A terminal of its own, by a link: nothing of the system's is at stake.
TEST_F(HostileOutput, ADeviceIsWrittenAndStaysOne) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(grantpt(terminal), 0);
  ASSERT_EQ(unlockpt(terminal), 0);
  const std::string device = ptsname(terminal);
  const int held = open(device.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC); // it does not hang up
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
    EXPECT_GT(bytes, 10u) << line.name;
  }
  over = true;
  reader.join();
  close(held);
  close(terminal);
}

TEST_F(HostileOutput, FoldersReadOnlyAndForeignFilesAreRefused) {
  const std::string foreign = "{\"of\": \"another kind\"}\n";
  for (const CommandLine& line : fileCommands()) {
    const std::string file = folder / ("file" + line.extension),
                      place = folder / ("folder" + line.extension);
    fs::create_directory(place);
    expectOneLineError(run(line.to(place)), {"it is a folder"});
    ASSERT_EQ(run(line.to(file)).exit, 0) << line.name;
    fs::permissions(file, fs::perms::owner_read);
    expectUntouched(line, file, {"it is read-only"});
    fs::permissions(file, fs::perms::owner_all);
    auto keeping = line;
    keeping.words.push_back("--no-clobber");
    expectUntouched(keeping, file, {"--no-clobber"});
    folder.write("file" + line.extension, foreign);
    expectUntouched(line, file, {"is a JSON file", "not overwritten"});
    folder.write("file" + line.extension, "Dear reader, this is prose.\nIt has two lines.\n");
    expectUntouched(line, file, {"not overwritten"});
    folder.write("file" + line.extension, ""); // nothing is lost
    EXPECT_EQ(run(line.to(file)).exit, 0) << line.name;
    fs::remove(place);
    fs::remove(file);
    fs::create_symlink(fs::path(file).filename(), file); // to itself
    expectOneLineError(run(line.to(file)), {"symbolic links"});
    fs::remove(file);
  }
}

TEST_F(HostileOutput, WhereAFolderIsMeantNothingElseIsReplaced) {
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

TEST_F(HostileOutput, AnExportReplacesItsOwnFilesOnly) {
  const std::string out = folder / "out";
  ASSERT_EQ(run({"export", workspace, "-o", out}).exit, 0);
  const std::string before = fingerprint(out);
  ASSERT_EQ(run({"export", workspace, "-o", out}).exit, 0);
  EXPECT_EQ(fingerprint(out), before);
  folder.write("out/vertices.csv", "{\"a\": 1}");
  const std::string foreign = fingerprint(out);
  expectOneLineError(run({"export", workspace, "-o", out}), {"vertices.csv", "a JSON file"});
  EXPECT_EQ(fingerprint(out), foreign);
}

TEST_F(HostileOutput, DashIsAStream) {
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

TEST_F(HostileOutput, APipeWithoutAnOtherEndIsAnErrorAndNoWait) {
  const std::string pipe = folder / "pipe.csv";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expectOneLineError(run({"sample", box, "--points", pipe, "-o", folder / "x.csv"}),
                     {"pipe.csv", "nobody writes"});
  expectOneLineError(run({"sample", box, "--points", points, "-o", pipe}),
                     {"pipe.csv", "nobody reads"});
}

} // namespace
} // namespace patina::test
