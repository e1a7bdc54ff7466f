// A command's reported edits are in the workspace afterwards, and those that it reports as failed
// are not: if the disk refuses any call, without locks, and after kill -9.
#include <chrono>
#include <csignal>
#include <random>
#include <sstream>
#include <thread>

#include "integration/every_command.h"
#include "session/store/journal_fold.h"
#include "support/longer.h"
#include "support/places.h"

namespace patina::test {
namespace {

namespace fs = std::filesystem;
using Settings = std::vector<std::pair<std::string, std::string>>;

class Promises : public EveryCommand {
 protected:
  struct Change {
    std::string name;
    std::vector<std::string> words;
    std::string output; // what it changes
    bool has_intent = true;
    std::string before{}, after{}; // states of the output
  };

  // The workspace has two edits, and one that was undone.
  void SetUp() override {
    EveryCommand::SetUp();
    ASSERT_EQ(run({"undo", workspace}).exit, 0);
    const std::string one = script(
        "one.json",
        {stroke(Tool::material(MaterialChannel::static_friction), 0.4, 0.006, {{0, 0, kTop}}),
         stroke(Tool::color, 1, 0.004, {{0.01, 0, kTop}}),
         stroke(Tool::relief, 3e-4, 0.005, {{-0.02, 0, kTop}})});
    const std::string scan = folder / "short";
    ASSERT_EQ(run({"simulate-scan", box, "-o", scan, "--seconds", "1"}).exit, 0);
    folder.write("aside.txt", "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    const std::string made = folder / "made", copy = folder / "copy";
    changes = {
        {"set", {"scene", "-o", workspace, "--set", "stiffness=321"}, workspace},
        {"add", {"scene", "-o", workspace, "--add", box + "@" + (folder / "aside.txt")}, workspace},
        {"scan", {"scene", "-o", workspace, "--scan", scan}, workspace},
        {"paint", {"paint", workspace, "--strokes", one, "-o", workspace}, workspace},
        {"undo", {"undo", workspace, "--steps", "2"}, workspace},
        {"redo", {"redo", workspace}, workspace},
        {"make", {"scene", "-o", made, "--add", box}, made},
        {"copy", {"paint", workspace, "--strokes", one, "-o", copy}, copy}};
    original = folder / "original";
    fs::copy(workspace, original, fs::copy_options::recursive);
  }

  // Adds the commands that write files of a scan.
  void addScanCommands() {
    makeScan();
    const std::string film = "replay:" + (folder / "film"), path = folder / "path.csv",
                      registered = folder / "registered.csv", out = folder / "out.csv",
                      obj = folder / "out.obj", recording = folder / "recording";
    changes.push_back({"register", {"register", box, path, "-o", out}, out, false});
    changes.push_back({"map-texture", {"map-texture", box, registered, "-o", obj}, obj, false});
    changes.push_back({"record", {"record", film, "-o", recording}, recording, false});
  }

  void startAnew() const {
    for (const Change& change : changes) fs::remove_all(change.output);
    fs::copy(original, workspace, fs::copy_options::recursive);
  }

  // Every file of a workspace that its history needs is read, too.
  static std::string stateOf(const std::string& output) {
    if (!fs::exists(output)) return "";
    if (fs::is_regular_file(output)) return readFile(output);
    if (output.ends_with("recording")) return recordingState(output);
    if (!isWorkspace(output)) return isUnfinishedWorkspace(output) ? "" : "is no workspace";
    const OpenedWorkspace opened = openWorkspace(output);
    const FoldedJournal fold = folded(opened.journal, output);
    std::string text = "edits done: " + std::to_string(fold.position) + "\n";
    for (const FoldedJournal::Step& step : fold.steps) {
      JournalEvent event = *step.event;
      if (const auto* scene = std::get_if<StoredSceneEdit>(&event)) loadState(output, scene->state);
      event.time = 0;
      event.intent.clear();
      text += journalLine(1, event);
    }
    return text;
  }
  // A recording that has begun stays, because the hand's motion cannot be repeated.
  static std::string recordingState(const std::string& scan) {
    if (!fs::exists(scan + "/frames.csv")) return "";
    const auto frames = std::distance(fs::directory_iterator(scan + "/frames"), {});
    const std::string table = readFile(scan + "/frames.csv");
    const auto rows = std::count(table.begin(), table.end(), '\n') - 1;
    return rows > 0 && frames >= rows ? "recorded" : "";
  }

  // Determines the states of each output before and after.
  void learn() {
    for (Change& change : changes) {
      startAnew();
      change.before = stateOf(change.output);
      const Outcome outcome = run(change.words);
      ASSERT_LE(outcome.exit, 1) << change.name << outcome.err;
      change.after = stateOf(change.output);
      ASSERT_NE(change.after, change.before) << change.name;
    }
  }

  static std::vector<std::string> withIntent(const Change& change) {
    std::vector<std::string> words = change.words;
    if (change.has_intent) words.insert(words.end(), {"--intent", "try-1"});
    return words;
  }

  Settings shim(const Settings& more) const {
    Settings all = {{"LD_PRELOAD", preloadable("fault_shim.so")},
                    {"PATINA_NO_FLUSH", "1"},
                    {"PATINA_FAULT_WIDER", "1"},
                    {"PATINA_FAULT_UNDER", folder.path()}};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  static void expectOneLine(const std::string& said) {
    std::istringstream lines(said);
    int errors = 0;
    for (std::string line; std::getline(lines, line);)
      errors += !line.starts_with("patina: warning: ");
    EXPECT_EQ(errors, 1) << said;
  }

  // Checks the output after any end of the command.
  void judge(const Change& change, const Outcome& outcome, const std::string& what) {
    const std::string state = stateOf(change.output);
    const bool reported = outcome.exit <= 1 || !outcome.out.empty();
    const bool failed = outcome.exit == 2;
    EXPECT_TRUE(reported || failed || outcome.exit == 128 + SIGKILL) << what << outcome.exit;
    // A recording that the disk broke off is reported with exit code 1.
    const bool broken_off = change.name == "record" && outcome.exit == 1;
    const bool agrees = reported && !broken_off ? state == change.after
                        : failed                ? state == change.before
                                                : state == change.before || state == change.after;
    if (failed) expectOneLine(outcome.err);
    EXPECT_TRUE(agrees) << what << outcome.exit << " " << outcome.err << "is\n" << state;
    differences_ += !agrees;
    // A killed program leaves nothing that hinders the next one.
    if (outcome.exit == 128 + SIGKILL && !change.has_intent && state == change.before) {
      EXPECT_LE(run(change.words).exit, 1) << what;
      EXPECT_EQ(stateOf(change.output), change.after) << what;
    }
    if (!change.has_intent) return;
    const Environment environment(shim(more_));
    const Outcome again = run(withIntent(change)); // once, whether it had happened or not
    EXPECT_EQ(again.exit, 0) << what << again.err;
    EXPECT_EQ(stateOf(change.output), change.after) << what << again.err;
  }

  // Refuses every stride-th call, each with the next fault.
  void refuse(const Change& change, const std::vector<const char*>& faults, int stride) {
    const std::string mark = folder / "mark";
    int at = 1 + turn_ % stride;
    for (;; at += stride) {
      startAnew();
      fs::remove(mark);
      const std::string fault = faults[static_cast<std::size_t>(turn_++) % faults.size()];
      Settings settings = shim(more_);
      settings.insert(settings.end(), {{"PATINA_FAULT", fault},
                                       {"PATINA_FAULT_AT", std::to_string(at)},
                                       {"PATINA_FAULT_MARK", mark}});
      Outcome outcome;
      {
        const Environment environment(settings);
        outcome = run(withIntent(change));
      }
      if (!fs::exists(mark)) break;
      ++refused_;
      judge(change, outcome, change.name + ", " + fault + " at call " + std::to_string(at) + ": ");
      if (differences_ > 20) return;
    }
    if (!long_) return;
    std::printf("%s, %s: %d calls\n", change.name.c_str(), faults[0], at - 1);
    std::fflush(stdout);
  }

  const bool long_ = isLong();
  std::vector<Change> changes;
  std::string original;
  Settings more_; // further settings of the shim
  int refused_ = 0, differences_ = 0, turn_ = 0;
};

using Faults = std::vector<const char*>;

// The long form refuses each call with each fault, as tests of their own that can run side by side.
std::vector<Faults> faultsOfCalls() {
  const Faults all = {"enospc", "eio", "eintr", "estale", "enolck", "full", "kill"};
  if (!isLong()) return {all};
  std::vector<Faults> each;
  for (const char* fault : all) each.push_back({fault});
  return each;
}

class RefusedCall : public Promises, public testing::WithParamInterface<Faults> {};

TEST_P(RefusedCall, ExitCodeTellsWhatIsInTheHistory) {
  if (long_) addScanCommands();
  learn();
  for (const Change& change : changes) refuse(change, GetParam(), long_ ? 1 : 8);
  std::printf("%d refused calls, %d differences\n", refused_, differences_);
  EXPECT_GE(refused_, long_ ? 100 : 20);
}

INSTANTIATE_TEST_SUITE_P(Faults, RefusedCall, testing::ValuesIn(faultsOfCalls()),
                         [](const testing::TestParamInfo<Faults>& of) {
                           return of.param.size() > 1 ? "all" : std::string(of.param.front());
                         });

// The lock files of killed programs are told apart from those of living ones.
TEST_F(Promises, AKilledProgramsLockFileBlocksNobody) {
  changes.resize(1);
  learn();
  more_ = {{"PATINA_NO_LOCKS", "1"}};
  refuse(changes[0], {"kill"}, long_ ? 1 : 4);
  EXPECT_GT(refused_, 3);
}

TEST_F(Promises, KillsAtAnyTimeLoseNothingReported) {
  if (long_) addScanCommands();
  learn();
  const char* wanted = std::getenv("PATINA_KILLS");
  const int rounds = wanted ? std::atoi(wanted) : long_ ? 30 : 2;
  std::mt19937 random(43);
  int done = 0, undone = 0;
  for (const Change& change : changes) {
    startAnew();
    const auto begun = std::chrono::steady_clock::now();
    ASSERT_LE(run(change.words).exit, 1);
    const std::chrono::duration<double> usual = std::chrono::steady_clock::now() - begun;
    for (int round = 0; round < rounds; ++round) {
      startAnew();
      const std::string what = change.name + ", round " + std::to_string(round) + ": ";
      Running running(withIntent(change), programPath());
      std::this_thread::sleep_for(usual * (static_cast<double>(random() % 1100) / 1000));
      running.signal(SIGKILL);
      const Outcome outcome = running.wait();
      ++(stateOf(change.output) == change.after ? done : undone);
      judge(change, outcome, what);
      if (HasFailure()) return;
    }
  }
  std::printf("%d killed: %d done, %d not, %d differences\n", done + undone, done, undone,
              differences_);
  EXPECT_GT(undone, 0);
}

TEST_F(Promises, SixWritersWithoutLocksLoseNothingReported) {
  const int rounds = long_ ? 100 : 5;
  const Environment no_locks(shim({{"PATINA_NO_LOCKS", "1"}}));
  int all_done = 0;
  for (int round = 0; round < rounds; ++round) {
    startAnew();
    std::vector<std::unique_ptr<Running>> writers;
    for (int i = 0; i < 6; ++i)
      writers.push_back(std::make_unique<Running>(
          std::vector<std::string>{"scene", "-o", workspace, "--set",
                                   "stiffness=" + std::to_string(401 + i)},
          programPath()));
    std::vector<Outcome> outcomes;
    for (const auto& writer : writers) outcomes.push_back(writer->wait());
    const std::string state = stateOf(workspace);
    int done = 0, number = 401;
    for (const Outcome& outcome : outcomes) {
      const std::string value = "[\"stiffness\",\"" + std::to_string(number++) + "\"]";
      const bool there = state.find(value) != std::string::npos;
      EXPECT_EQ(outcome.exit, there ? 0 : 2) << "round " << round << outcome.err;
      if (outcome.exit == 0)
        EXPECT_NE(outcome.err.find("has no locks"), std::string::npos) << outcome.err;
      else
        expectOneLineError(outcome, {});
      done += outcome.exit == 0;
    }
    EXPECT_GE(done, 1);
    all_done += done;
    for (const auto& file : fs::directory_iterator(workspace))
      EXPECT_FALSE(file.path().string().ends_with(".lock")) << file.path();
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
  std::printf("%d rounds of six writers: %d edits reported, 0 lost\n", rounds, all_done);
}

TEST_F(Promises, ALockFileOfAnotherMachineIsNamedAndRespected) {
  const std::string lock =
      workspace + "/." + openWorkspace(workspace).journal_file.filename().string() + ".lock";
  folder.write("box/" + fs::path(lock).filename().string(),
               "elsewhere boot pid:[1]\n4711\n99\n2026-11-25T09:06:47Z\n");
  const Environment no_locks(shim({{"PATINA_NO_LOCKS", "1"}}));
  expectOneLineError(run(changes[0].words), {"4711", "elsewhere", "2026-11-25T09:06:47Z", lock});
  fs::remove(lock);
  EXPECT_EQ(run(changes[0].words).exit, 0);
}

TEST_F(Promises, AnIntentIsDoneOnceAndWithoutOneNothingIsARepetition) {
  learn();
  for (const Change& change : changes) {
    startAnew();
    ASSERT_EQ(run(withIntent(change)).exit, 0);
    const Outcome again = run(withIntent(change));
    EXPECT_EQ(again.exit, 0) << again.err;
    EXPECT_NE(again.err.find("try-1 is in it already"), std::string::npos) << again.err;
    EXPECT_EQ(stateOf(change.output), change.after) << change.name;
  }
  startAnew();
  for (int i = 0; i < 2; ++i) ASSERT_EQ(run(changes[0].words).exit, 0);
  EXPECT_EQ(openWorkspace(workspace).journal.size(), openWorkspace(original).journal.size() + 2);
  expectOneLineError(run({"undo", workspace, "--intent", "a b"}), {"--intent", "'a b'"});
}

TEST_F(Promises, AFullDiskBehindStdoutDoesNotMakeADoneEditFail) {
  const Outcome outcome = Running({"-c", "exec \"$0\" \"$@\" > /dev/full", programPath().string(),
                                   "scene", "-o", workspace, "--set", "stiffness=321"},
                                  "/bin/bash")
                              .wait();
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_NE(outcome.err.find("warning: standard output"), std::string::npos) << outcome.err;
  EXPECT_EQ(loadWorkspace(workspace).haptics.stiffness, 321);
}

} // namespace
} // namespace patina::test
