// The program on a disk that refuses calls, and the libraries that it loads at its start.
#include <csignal>
#include <cstdlib>
#include <functional>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "core/file.h"
#include "integration/every_command.h"
#include "support/longer.h"
#include "support/places.h"

namespace patina::test {
namespace {

// Removes warnings: a stroke over itself changes nothing, and this is reported before anything
// fails.
std::string withoutWarnings(const std::string& said) {
  std::istringstream lines(said);
  std::string kept;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("patina: warning: ")) kept += line + "\n";
  return kept;
}

std::set<std::string> namesIn(const std::filesystem::path& folder) {
  std::set<std::string> names;
  if (std::filesystem::is_directory(folder))
    for (const auto& file : std::filesystem::directory_iterator(folder))
      names.insert(file.path().filename());
  return names;
}

// Each call that changes the disk fails in turn, for each command: the same command succeeds the
// second time, and earlier files are kept.
class RefusingDisk : public EveryCommand {
 protected:
  // Returns false once the command makes no more calls than `at`.
  bool refuse(const CommandLine& line, const std::string& fault, int at, const std::string& out) {
    const std::string mark = folder / "mark",
                      what = line.name + ", " + fault + " at call " + std::to_string(at);
    std::filesystem::remove(mark);
    Outcome outcome;
    {
      const Environment shim({{"LD_PRELOAD", preloadable("fault_shim.so")},
                              {"PATINA_FAULT", fault},
                              {"PATINA_FAULT_AT", std::to_string(at)},
                              {"PATINA_FAULT_UNDER", folder.path()},
                              {"PATINA_FAULT_MARK", mark}});
      outcome = run(line.to(out));
    }
    if (!std::filesystem::exists(mark)) {
      EXPECT_LE(outcome.exit, 1) << what << outcome.err; // 1: it did not converge
      return false;
    }
    ++refused_;
    if (fault == "kill") {
      EXPECT_EQ(outcome.exit, 128 + SIGKILL) << what;
    } else if (outcome.exit > 1) { // the call had to succeed
      outcome.err = withoutWarnings(outcome.err);
      expectOneLineError(outcome, {});
    }
    // The index is written last: if it is there, all that a retry makes exists already.
    const bool whole = std::filesystem::exists(out + "/scene.vtm");
    const std::set<std::string> had = namesIn(out);
    const std::string next = line.writes == Writes::recording ? out + "-next" : out;
    if (next != out) std::filesystem::remove_all(next);
    const Outcome again = run(line.to(next));
    EXPECT_LE(again.exit, 1) << what << ": the retry is blocked: " << again.err;
    if (line.writes == Writes::folder && whole) {
      for (const std::string& name : namesIn(out)) EXPECT_TRUE(had.count(name)) << what << name;
    }
    if (line.writes == Writes::workspace) {
      EXPECT_EQ(run({"info", out}).exit, 0) << what;
    }
    return true;
  }

  // The long form tests all calls; the short form one or two for each command and fault, in
  // alternation.
  void refuseInTurn(const std::vector<CommandLine>& lines, const std::vector<const char*>& faults,
                    const std::function<std::string(const CommandLine&)>& output) {
    for (const CommandLine& line : lines)
      for (const char* fault : faults) {
        const int first = long_ ? 1 : 1 + 5 * turn_++ % 13, last = long_ ? 2000 : first;
        int at = first;
        while (at <= last && refuse(line, fault, at, output(line))) ++at;
        if (!long_) continue;
        EXPECT_LE(at, last) << line.name << " makes more calls than were refused";
        std::printf("%s, %s: %d calls\n", line.name.c_str(), fault, at - first);
        std::fflush(stdout);
      }
  }

  const bool long_ = longer(1) > 1;
  int refused_ = 0, turn_ = 0;
};

using Faults = std::vector<const char*>;

// The long form makes each fault a test of its own, so that they can run side by side.
std::vector<Faults> faultsInTurn() {
  if (longer(1) == 1) return {{"kill", "enospc", "eio", "full"}};
  return {{"kill"}, {"enospc"}, {"eio"}, {"full"}};
}

class RefusingDiskInTurn : public RefusingDisk, public testing::WithParamInterface<Faults> {};

TEST_P(RefusingDiskInTurn, BlocksNoRetryAndBreaksNothing) {
  const std::string kept = fingerprint(workspace);
  std::vector<CommandLine> lines = folderCommands();
  if (long_) makeScan();
  for (const std::vector<CommandLine>& more :
       {fileCommands(), long_ ? scanFileCommands() : std::vector<CommandLine>()})
    for (const CommandLine& line : more)
      if (long_ || line.name == "sample" || line.name == "field") lines.push_back(line);
  if (long_) {
    for (const CommandLine& line : scanFolderCommands()) lines.push_back(line);
    lines.push_back({"study", {"study", "field", "--quick", "-o", "OUT"}, "", Writes::folder});
  }
  if (!long_) std::erase_if(lines, [](const CommandLine& line) { return line.name == "man"; });
  refuseInTurn(lines, GetParam(), [&](const CommandLine& line) {
    const std::string out = folder / ("out" + line.extension);
    std::filesystem::remove_all(out);
    return out;
  });
  EXPECT_EQ(fingerprint(workspace), kept);
  EXPECT_EQ(run({"info", workspace}).exit, 0);
  std::printf("%d refused calls\n", refused_);
  EXPECT_GT(refused_, long_ ? 75 : 15);
}

INSTANTIATE_TEST_SUITE_P(Faults, RefusingDiskInTurn, testing::ValuesIn(faultsInTurn()),
                         [](const testing::TestParamInfo<Faults>& of) {
                           return of.param.size() > 1 ? "all" : std::string(of.param.front());
                         });

// One failed read must not lose the history.
TEST_F(RefusingDisk, OneDiskErrorLosesNoHistoryInARecovery) {
  const std::int64_t edits = runJson({"undo", workspace, "--list"}).at("history").asInteger();
  ASSERT_GE(edits, 3);
  for (int at = 1; at < 60; at += long_ ? 1 : 4) {
    const std::string out = folder / "mended", mark = folder / "mark";
    std::filesystem::remove_all(out);
    std::filesystem::remove(mark);
    Outcome outcome;
    {
      const Environment shim({{"LD_PRELOAD", preloadable("fault_shim.so")},
                              {"PATINA_FAULT", "eio"},
                              {"PATINA_FAULT_READS", "1"},
                              {"PATINA_FAULT_AT", std::to_string(at)},
                              {"PATINA_FAULT_UNDER", folder.path()},
                              {"PATINA_FAULT_MARK", mark}});
      outcome = run({"scene", "-o", out, "--recover", workspace});
    }
    if (outcome.exit == 0) {
      EXPECT_EQ(runJson({"undo", out, "--list"}).at("history").asInteger(), edits) << at;
    } else {
      expectOneLineError(outcome, {});
    }
    if (!std::filesystem::exists(mark)) {
      EXPECT_GT(at, 10);
      break;
    }
  }
}

TEST(Start, LoadsNoPictureLibrary) {
  const Environment trace(std::vector<std::pair<std::string, std::string>>{{"LD_DEBUG", "files"}});
  const Outcome outcome = run({"--help"});
  EXPECT_NE(outcome.err.find("libstdc++"), std::string::npos); // the trace is there
  EXPECT_EQ(outcome.err.find("OpenImageIO"), std::string::npos);
  EXPECT_EQ(outcome.err.find("patina_images"), std::string::npos);
}

} // namespace
} // namespace patina::test
