// The program on a disk that refuses, and what it loads at its start.
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

// What is painted over itself changes nothing, and that is said before anything fails.
std::string withoutWarnings(const std::string& said) {
  std::istringstream lines(said);
  std::string kept;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("patina: warning: ")) kept += line + "\n";
  return kept;
}

TEST(DiskFault, ARefusedSaveIsOneLineAndExit2AndTheWorkspaceStays) {
  const ScratchFolder scratch;
  const std::string folder = scratch / "pot", mark = scratch / "mark";
  const std::filesystem::path source = sourceFolder();
  const std::string mesh = source / "tests" / "fuzz" / "corpus" / "ply" / "ascii.ply";
  ASSERT_EQ(run({"scene", "-o", folder, "--add", mesh}).exit, 0);
  int refused = 0;
  for (int at = 1; at < 100; ++at) {
    const std::string before = readFile(folder + "/workspace.json");
    std::filesystem::remove(mark);
    Outcome outcome;
    {
      const Environment fault({{"LD_PRELOAD", preloadable("fault_shim.so")},
                               {"PATINA_FAULT", "full"},
                               {"PATINA_FAULT_AT", std::to_string(at)},
                               {"PATINA_FAULT_UNDER", folder},
                               {"PATINA_FAULT_MARK", mark}});
      outcome = run({"scene", "-o", folder, "--set", "stiffness=" + std::to_string(100 + at)});
    }
    EXPECT_EQ(run({"info", folder}).exit, 0) << "refused at call " << at;
    if (!std::filesystem::exists(mark)) {
      EXPECT_EQ(outcome.exit, 0);
      break;
    }
    expectOneLineError(outcome, {folder, "No space left on device"});
    if (readFile(folder + "/workspace.json") == before) ++refused;
  }
  EXPECT_GE(refused, 5); // fewer would mean that the shim is not there
}

std::set<std::string> namesIn(const std::filesystem::path& folder) {
  std::set<std::string> names;
  if (std::filesystem::is_directory(folder))
    for (const auto& file : std::filesystem::directory_iterator(folder))
      names.insert(file.path().filename());
  return names;
}

// Each call that changes the disk fails in turn, for each command: nothing stands in the way of the
// same command a second time, and what was there before is there.
class RefusingDisk : public EveryCommand {
 protected:
  // False once the command makes no more calls than `at`.
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
    } else if (outcome.exit > 1) { // not a call that may fail, as where what is left is removed
      outcome.err = withoutWarnings(outcome.err);
      expectOneLineError(outcome, {});
    }
    if (judge_) judge_(what);
    // The index comes last: where it is, all that a retry makes is there already.
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

  // All calls in the long form; else one or two for each command and fault, ever other ones.
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

  // What the commands see of a workspace: its edits, values and objects. The hashes of its files
  // are left out.
  std::string stateOf(const std::string& folder_of) const {
    Json info = runJson({"info", folder_of, "--no-field"});
    std::string state = info.set("inputs", Json()).dump();
    const Json list = runJson({"undo", folder_of, "--list"});
    for (const Json& edit : list.at("edits").asArray())
      state += edit.at("what").asString() + (edit.at("done").asBool() ? " done\n" : " undone\n");
    return state;
  }

  const bool long_ = longer(1) > 1;
  int refused_ = 0, turn_ = 0;
  std::function<void(const std::string&)> judge_; // after a fault, before it is done again
};

using Faults = std::vector<const char*>;

// In the long form each fault is a test of its own, so that they can run side by side.
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

TEST_F(RefusingDisk, LeavesAWorkspaceThatIsChangedInPlaceAsItWasOrAsItIsToBe) {
  const std::string one = script(
      "one.json",
      {stroke(Tool::material(MaterialChannel::static_friction), 0.4, 0.006, {{0, 0, kTop}})});
  const CommandLine set{"set", {"scene", "-o", workspace, "--set", "stiffness=321"}, ""};
  const CommandLine add{"add", {"scene", "-o", workspace, "--add", box}, ""};
  const CommandLine paint{"paint", {"paint", workspace, "--strokes", one, "-o", workspace}, ""};
  const CommandLine undo{"undo", {"undo", workspace}, ""};
  const std::string start = folder / "start";
  std::filesystem::copy(workspace, start, std::filesystem::copy_options::recursive);
  const auto startAnew = [&] {
    std::filesystem::remove_all(workspace);
    std::filesystem::copy(start, workspace, std::filesystem::copy_options::recursive);
  };
  const std::string before = stateOf(workspace);
  int as_it_was = 0;
  for (const CommandLine& line : {set, add, paint, undo}) {
    startAnew();
    ASSERT_EQ(run(line.to(workspace)).exit, 0) << line.name;
    const std::string after = stateOf(workspace);
    ASSERT_NE(after, before) << line.name;
    judge_ = [&](const std::string& what) {
      const std::string state = stateOf(workspace);
      EXPECT_TRUE(state == before || state == after) << what << '\n' << state << before << after;
      as_it_was += state == before;
    };
    refuseInTurn({line}, {"kill", "eio", "full"}, [&](const CommandLine&) {
      startAnew();
      return workspace;
    });
  }
  EXPECT_EQ(run({"info", workspace}).exit, 0);
  EXPECT_GT(refused_, long_ ? 60 : 8);
  EXPECT_GT(as_it_was, 0);
}

// One failure while it reads must not cost the history.
TEST_F(RefusingDisk, OneErrorOfTheDiskCostsARecoveryNoHistory) {
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

TEST(Start, LoadsNoLibraryOfPictures) {
  const Environment trace(std::vector<std::pair<std::string, std::string>>{{"LD_DEBUG", "files"}});
  const Outcome outcome = run({"--help"});
  EXPECT_NE(outcome.err.find("libstdc++"), std::string::npos); // the trace is there
  EXPECT_EQ(outcome.err.find("OpenImageIO"), std::string::npos);
  EXPECT_EQ(outcome.err.find("patina_images"), std::string::npos);
}

} // namespace
} // namespace patina::test
