// A scene without a folder survives the death of its program, and leaves nothing after a clean end.
#include "session/store/autosave.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/edit_desk.h"

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

// Runs in a program of its own, that kills itself when the last of its strokes is done.
TEST(Autosave, DISABLED_PaintsAndIsKilled) {
  const char* root = std::getenv(kRoot);
  ASSERT_NE(root, nullptr);
  Desk desk(root);
  desk.open(oneBall());
  for (int i = 0; i < kStrokes; ++i) {
    const Stroke stroke = strokeOf(i);
    desk.edits.beginStroke(stroke.brush);
    desk.edits.dabs(stroke.samples);
    desk.edits.endStroke();
  }
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == kStrokes; }));
  desk.edits.beginStroke(stiffBrush()); // the one that is lost
  desk.edits.dabs(circle(6));
  kill(getpid(), SIGKILL);
}

TEST(Autosave, EveryStrokeThatWasDoneIsThereAfterAKill) {
  const Folder folder;
  const pid_t child = fork();
  if (child == 0) {
    setenv(kRoot, folder.path().c_str(), 1);
    execl("/proc/self/exe", "app_tests", "--gtest_also_run_disabled_tests",
          "--gtest_filter=Autosave.DISABLED_PaintsAndIsKilled", nullptr);
    _exit(1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it was to be killed";

  const auto places = leftBehind(folder.path());
  ASSERT_EQ(places.size(), 1u);
  Autosave::adopt(places[0]); // a recovery that fails or is cancelled
  ASSERT_EQ(leftBehind(folder.path()), places) << "nobody had the scene, and it is gone";
  auto autosave = Autosave::adopt(places[0]);
  EXPECT_TRUE(leftBehind(folder.path()).empty()) << "it is taken";
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

TEST(Autosave, NothingIsWrittenBeforeAnEditAndNothingStaysAfterACleanEnd) {
  const Folder folder;
  {
    Desk desk(folder.path() / "state");
    desk.open(oneBall());
    ASSERT_TRUE(desk.settle());
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "state"));
    desk.edits.beginStroke(stiffBrush());
    desk.edits.dabs(circle(5));
    desk.edits.endStroke();
    ASSERT_TRUE(desk.settle());
    EXPECT_FALSE(std::filesystem::is_empty(folder.path() / "state"));
    EXPECT_TRUE(leftBehind(folder.path() / "state").empty()) << "this program lives";
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "state"));
}

// A program that is told to end, with nobody to ask, does not lose what a kill would keep.
TEST(Autosave, WhatIsNotSavedStaysWhereNobodyCanBeAsked) {
  const Folder folder;
  for (const bool edited : {false, true}) {
    {
      Desk desk(folder.path());
      desk.open(oneBall());
      ASSERT_TRUE(desk.settle());
      if (edited) {
        desk.edits.beginStroke(stiffBrush());
        desk.edits.dabs(circle(5));
        desk.edits.endStroke();
        ASSERT_TRUE(desk.settle());
      }
      desk.edits.leaveBehind();
    }
    const auto places = leftBehind(folder.path());
    ASSERT_EQ(places.size(), edited ? 1U : 0U);
    if (!edited) continue;
    Progress progress;
    const auto autosave = Autosave::adopt(places[0]);
    const auto editor = Editor::open(autosave->workspace(), {true, true, kHistoryBudget}, progress);
    EXPECT_EQ(editor->history().undoable(), 1U);
  }
}

TEST(Autosave, ADiskThatRefusesIsToldOfOnceAndPaintingGoesOn) {
  Desk desk("/proc/no/state");
  desk.open(oneBall());
  for (int i = 0; i < 2; ++i) {
    desk.edits.beginStroke(stiffBrush());
    desk.edits.dabs(circle(5, i, i + 0.2));
    desk.edits.endStroke();
  }
  ASSERT_TRUE(desk.settle());
  EXPECT_EQ(desk.status.done, 2u);
  EXPECT_EQ(desk.problems.size(), 1u);
}

} // namespace
} // namespace patina
