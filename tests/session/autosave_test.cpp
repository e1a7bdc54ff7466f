// A scene without a folder survives a crash, and leaves nothing after a clean end.
#include "session/store/autosave.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "session/edit_desk.h"

namespace patina {
namespace {

using test::circle;
using test::Desk;
using test::Folder;
using test::oneBall;
using test::stiffBrush;

constexpr const char* kRoot = "PATINA_TEST_STATE";
constexpr int kStrokes = 3;

Stroke strokeOf(int number) {
  return {stiffBrush(600 + 100 * number), circle(6, 0.5 * number, 0.5 * number + 0.3)};
}

// Runs in a separate process that kills itself after the last of its strokes.
TEST(Autosave, DISABLED_PaintsAndIsKilled) {
  const char* root = std::getenv(kRoot);
  ASSERT_NE(root, nullptr);
  Desk desk(root);
  desk.open(oneBall());
  for (int i = 0; i < kStrokes; ++i) {
    const Stroke stroke = strokeOf(i);
    desk.stroke(stroke.brush, stroke.samples);
  }
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == kStrokes; }));
  desk.press(stiffBrush(), circle(6)); // the lost stroke
  kill(getpid(), SIGKILL);
}

TEST(Autosave, EveryFinishedStrokeSurvivesAKill) {
  const Folder folder;
  const pid_t child = fork();
  if (child == 0) {
    setenv(kRoot, folder.path().c_str(), 1);
    execl("/proc/self/exe", "session_tests", "--gtest_also_run_disabled_tests",
          "--gtest_filter=Autosave.DISABLED_PaintsAndIsKilled", nullptr);
    _exit(1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it was to be killed";

  const auto places = recoverableScenes(folder.path());
  ASSERT_EQ(places.size(), 1u);
  Autosave::adopt(places[0]); // a recovery that fails or is cancelled
  ASSERT_EQ(recoverableScenes(folder.path()), places) << "nobody had the scene, and it is gone";
  auto autosave = Autosave::adopt(places[0]);
  EXPECT_TRUE(recoverableScenes(folder.path()).empty()) << "it is taken";
  Progress progress;
  Desk desk(folder.path());
  auto editor = Editor::open(autosave->workspace(), {true, true, kHistoryBudget}, progress,
                             desk.edits.listener());
  desk.edits.adopt(std::move(editor), std::move(autosave));
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == kStrokes; }));
  EXPECT_TRUE(desk.status.unsaved);
  EXPECT_FALSE(desk.status.folder.has_value());

  Editor painted(oneBall(), progress);
  for (int i = 0; i < kStrokes; ++i) painted.apply(strokeOf(i), progress);
  EXPECT_TRUE(same(*desk.compiled->scene.objects[0].paint, *painted.scene().objects[0].paint));

  desk.edits.saveAs(folder.path() / "ws");
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.folder.has_value(); }));
  EXPECT_EQ(desk.status.edits.size(), static_cast<std::size_t>(kStrokes)) << "the history too";
  EXPECT_FALSE(std::filesystem::exists(places[0]));
}

TEST(Autosave, WritesNothingBeforeAnEditAndLeavesNothingAfterACleanEnd) {
  const Folder folder;
  {
    Desk desk(folder.path() / "state");
    desk.open(oneBall());
    ASSERT_TRUE(desk.settle());
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "state"));
    desk.stroke(stiffBrush(), circle(5));
    ASSERT_TRUE(desk.settle());
    EXPECT_FALSE(std::filesystem::is_empty(folder.path() / "state"));
    EXPECT_TRUE(recoverableScenes(folder.path() / "state").empty()) << "this program lives";
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "state"));
}

// A program that must end and cannot query the user keeps at least as much as after a kill.
TEST(Autosave, KeepsUnsavedEditsIfTheUserCannotBeAsked) {
  const Folder folder;
  for (const bool edited : {false, true}) {
    {
      Desk desk(folder.path());
      desk.open(oneBall());
      ASSERT_TRUE(desk.settle());
      if (edited) {
        desk.stroke(stiffBrush(), circle(5));
        ASSERT_TRUE(desk.settle());
      }
      desk.edits.keepForRecovery();
    }
    const auto places = recoverableScenes(folder.path());
    ASSERT_EQ(places.size(), edited ? 1U : 0U);
    if (!edited) continue;
    Progress progress;
    const auto autosave = Autosave::adopt(places[0]);
    const auto editor = Editor::open(autosave->workspace(), {true, true, kHistoryBudget}, progress);
    EXPECT_EQ(editor->history().undoable(), 1U);
  }
}

TEST(Autosave, OffersNothingOfAnotherUserAndWritesNothingIntoTheirFolder) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a folder away";
  const Folder folder;
  const auto give = [](const std::filesystem::path& to, uid_t whose) {
    ASSERT_EQ(chown(to.c_str(), whose, whose), 0);
  };
  {
    Desk desk(folder.path());
    desk.open(oneBall());
    desk.stroke(stiffBrush(), circle(5));
    ASSERT_TRUE(desk.settle());
    desk.edits.keepForRecovery();
  }
  const auto places = recoverableScenes(folder.path());
  ASSERT_EQ(places.size(), 1U);
  give(places[0], 65533);
  EXPECT_TRUE(recoverableScenes(folder.path()).empty());
  give(places[0], 0);
  EXPECT_EQ(recoverableScenes(folder.path()), places);
  give(folder.path(), 65533);
  EXPECT_THROW(Autosave{folder.path()}, FileError);
}

TEST(Autosave, StateFolderWithoutAHomeIsTheUsersOwn) {
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  const char* state = std::getenv("XDG_STATE_HOME");
  const std::string before = state ? state : "";
  unsetenv("HOME");
  unsetenv("XDG_STATE_HOME");
  EXPECT_EQ(stateFolder().filename(), "patina-state-" + std::to_string(geteuid()));
  if (!home.empty()) setenv("HOME", home.c_str(), 1);
  if (state) setenv("XDG_STATE_HOME", before.c_str(), 1);
}

TEST(Autosave, DiskFailureIsReportedOnceAndPaintingContinues) {
  Desk desk("/proc/no/state");
  desk.open(oneBall());
  for (int i = 0; i < 2; ++i) {
    desk.stroke(stiffBrush(), circle(5, i, i + 0.2));
  }
  ASSERT_TRUE(desk.settle());
  EXPECT_EQ(desk.status.done, 2u);
  EXPECT_EQ(desk.problems.size(), 1u);
}

TEST(Autosave, RecordingOfAKilledProgramIsOffered) {
  const Folder folder;
  std::filesystem::path left;
  {
    Autosave place(folder.path());
    std::ofstream(place.recording()) << "t [s]\n";
    EXPECT_TRUE(recoverableScenes(folder.path()).empty()) << "this program lives";
    place.keepForRecovery();
    left = place.recording().parent_path();
  }
  ASSERT_EQ(recoverableScenes(folder.path()), std::vector{left});
  EXPECT_TRUE(holdsRecording(left));
  Autosave::adopt(left)->claim();
  EXPECT_FALSE(std::filesystem::exists(left));
}

} // namespace
} // namespace patina
