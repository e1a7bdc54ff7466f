// A disk that refuses one call, or a program that is killed in it, for each call in turn.
#include "workspace/child_process.h"
#include "workspace/workspace_support.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr int kKilled = 128 + 9;
constexpr int kFarMoreThanThereAre = 500;

class DiskFault : public WorkspaceTest {
 protected:
  DiskFault() : before(paintedScene(0.05, 1, With::material)) {
    saveWorkspace(before, fresh());
    const OpenedWorkspace opened = openWorkspace(fresh());
    JournalWriter journal(opened.journal_file, 0);
    journal.append(someStroke(9, 700));
    saveWorkspace(before, 1, opened.states, fresh());
  }
  fs::path fresh() const { return root / "fresh"; }
  void renew() const {
    fs::remove_all(folder);
    fs::copy(fresh(), folder, fs::copy_options::recursive);
  }
  static std::size_t linesOf(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  static bool hasLine(const std::string& text, const std::string& line) {
    return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
  }
  // Checks the workspace after any result of `edit`.
  void expectWhole(const ChildEnd& end, const std::string& where) const {
    const OpenedWorkspace found = openWorkspace(folder);
    std::size_t records = 1;
    for (const char* line : {"stroke", "scene", "undo"}) records += hasLine(end.out, line);
    EXPECT_GE(found.journal.size(), records) << where;
    EXPECT_LE(found.journal.size(), records + 1) << where;
    if (found.event == 1)
      EXPECT_TRUE(same(found.scene, before)) << where;
    else
      EXPECT_EQ(found.scene.haptics.stiffness, 100 + 3) << where;
    EXPECT_TRUE(found.event == 3 || !hasLine(end.out, "saved")) << where;
    for (const StoredState& state : found.states) loadState(folder, state.file);
    for (const JournalEvent& event : found.journal)
      if (const auto* scene = std::get_if<StoredSceneEdit>(&event)) loadState(folder, scene->state);
  }
  // Runs `command` with the fault at each call until there is no such call; returns how many.
  template <typename Judge>
  int atEveryCall(const std::string& command, const std::string& kind, const Judge& judge) const {
    for (int at = 1; at < kFarMoreThanThereAre; ++at) {
      renew();
      const ChildEnd end = runChild(command, folder, {kind, at});
      const std::string where = kind + " at call " + std::to_string(at) + ": " + end.err;
      if (!end.faulted) {
        EXPECT_EQ(end.code, 0) << where;
        return at - 1;
      }
      judge(end, where);
      if (testing::Test::HasFailure()) return at;
    }
    return kFarMoreThanThereAre;
  }
  Scene before;
};

class Refusal : public DiskFault, public testing::WithParamInterface<const char*> {};

TEST_P(Refusal, GivesOneLineAndLosesNothingForAnyCall) {
  int errors = 0;
  const int calls = atEveryCall("edit", GetParam(), [&](const ChildEnd& end, const auto& where) {
    expectWhole(end, where);
    if (end.code == 0) return; // this call only tidies, or flushes after the last rename
    ++errors;
    EXPECT_EQ(end.code, 2) << where;
    EXPECT_EQ(linesOf(end.err), 1u) << where;
    EXPECT_TRUE(end.err.starts_with("workspace_child: " + folder.string())) << where;
    const std::string cause = GetParam() == std::string("eio") ? "Input/output" : "No space left";
    EXPECT_TRUE(says(end.err, cause)) << where;
  });
  // Three records (write, flush), and material, layout, state and workspace.json (create, write,
  // flush, rename, flush of the folder): fewer calls would mean that the shim is not loaded.
  EXPECT_GE(calls, 6 + 4 * (GetParam() == std::string("full") ? 4 : 5));
  EXPECT_GE(errors, calls - 3);
}
INSTANTIATE_TEST_SUITE_P(DiskFault, Refusal, testing::Values("enospc", "eio", "full"));

class Interruption : public DiskFault, public testing::WithParamInterface<const char*> {};

TEST_P(Interruption, ChangesNothingForAnyCall) {
  const int calls = atEveryCall("edit", GetParam(), [&](const ChildEnd& end, const auto& where) {
    expectWhole(end, where);
    EXPECT_EQ(end.code, 0) << where;
    EXPECT_EQ(end.err, "") << where;
    EXPECT_EQ(openWorkspace(folder).journal.size(), 4u) << where;
  });
  EXPECT_GE(calls, 6);
}
INSTANTIATE_TEST_SUITE_P(DiskFault, Interruption, testing::Values("eintr", "short"));

// A failed record leaves no bytes that would damage the next one.
TEST_F(DiskFault, WritesTheNextRecordAfterAFailedOne) {
  for (const char* kind : {"enospc", "eio"}) {
    const int calls = atEveryCall("insist", kind, [&](const ChildEnd& end, const auto& where) {
      EXPECT_EQ(end.code, 0) << where;
      const OpenedWorkspace found = openWorkspace(folder);
      EXPECT_TRUE(found.notes.empty()) << where;
      ASSERT_EQ(found.journal.size(), 11u) << where;
      EXPECT_EQ(std::count(found.journal.begin(), found.journal.end(), JournalEvent(UndoEvent{})),
                1)
          << where;
    });
    EXPECT_EQ(calls, 20);
  }
}

TEST_F(DiskFault, LosesNothingReportedIfKilledInAnyCall) {
  const int calls = atEveryCall("edit", "kill", [&](const ChildEnd& end, const auto& where) {
    EXPECT_EQ(end.code, kKilled) << where;
    expectWhole(end, where);
    // Another program can continue from here, and the remains of the killed one are removed.
    EXPECT_EQ(runChild("edit", folder, {}).code, 0) << where;
    for (const char* part : {".", "paint", "states"})
      for (const auto& item : fs::directory_iterator(folder / part))
        EXPECT_FALSE(item.path().filename().string().ends_with(".tmp")) << where << item.path();
  });
  EXPECT_GE(calls, 26);
}

class Replacing : public DiskFault, public testing::WithParamInterface<const char*> {};

TEST_P(Replacing, LeavesTheOldOrTheNewWorkspaceWhole) {
  const Scene after = paintedScene(0.08, 2, With::material);
  int olds = 0, news = 0;
  atEveryCall("replace", GetParam(), [&](const ChildEnd& end, const auto& where) {
    const OpenedWorkspace found = openWorkspace(folder);
    const bool is_new = same(found.scene, after);
    EXPECT_TRUE(is_new || same(found.scene, before)) << where;
    EXPECT_EQ(found.journal.size(), is_new ? 0u : 1u) << where; // the histories do not mix
    // Once the new one is found, a later call never gives the old one.
    EXPECT_TRUE(is_new || news == 0) << where;
    EXPECT_EQ(end.code, GetParam() == std::string("kill") ? kKilled : is_new ? 0 : 2) << where;
    ++(is_new ? news : olds);
  });
  EXPECT_GE(olds, 25);
  EXPECT_GE(news, 1);
}
INSTANTIATE_TEST_SUITE_P(DiskFault, Replacing, testing::Values("enospc", "kill"));

TEST_F(DiskFault, KilledFirstSaveIsNotAWorkspace) {
  for (int at = 1; at < kFarMoreThanThereAre; ++at) {
    fs::remove_all(folder);
    const ChildEnd end = runChild("replace", folder, {"kill", at});
    if (isWorkspace(folder)) {
      EXPECT_TRUE(same(openWorkspace(folder).scene, paintedScene(0.08, 2, With::material)));
    }
    if (!end.faulted) break;
  }
  EXPECT_TRUE(isWorkspace(folder));
}

} // namespace
} // namespace patina
