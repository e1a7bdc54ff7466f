// Edits on a thread of their own: order, merging into one edit, and calls that do not block.
#include "session/edit/edit_thread.h"

#include <gtest/gtest.h>

#include "session/edit/editor.h"
#include "session/edit/value_edit.h"
#include "session/edit_desk.h"
#include "support/sanitized.h"
#include "support/small_disk.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

using test::circle;
using test::Desk;
using test::Folder;
using test::oneBall;
using test::stiffBrush;

std::shared_ptr<const Scene> renamed(const CompiledScene& present, const std::string& name) {
  auto scene = std::make_shared<Scene>(present.scene);
  scene->objects[0].name = name;
  return scene;
}

TEST(EditThread, IgnoresTheRestOfAGestureAfterARequest) {
  Desk desk;
  desk.open(oneBall());
  desk.press(stiffBrush(), circle(5));
  desk.edits.undo();
  desk.move(circle(5));       // the hand still presses
  ASSERT_TRUE(desk.settle()); // redoes the stroke
  EXPECT_EQ(desk.status.edits.size(), 1u);
  EXPECT_EQ(desk.status.done, 1u);
}

TEST(EditThread, KeepsTicksWithTheHandThatTheyBelongTo) {
  Desk desk;
  desk.open(oneBall());
  desk.edits.apply("finer", [](const CompiledScene& present) { // keeps the thread busy
    auto scene = std::make_shared<Scene>(present.scene);
    scene->field.resolution = 120;
    return scene;
  });
  desk.stroke(stiffBrush(700), circle(5, 0, 0.3));
  desk.edits.goTo(1000);
  desk.stroke(stiffBrush(900), circle(5, 2, 2.3));
  ASSERT_TRUE(desk.settle());
  EXPECT_EQ(desk.status.edits.size(), 3u);
}

TEST(EditThread, MakesNoEditOfCancelledPainting) {
  Desk desk;
  desk.open(oneBall());
  for (int i = 0; i < 20; ++i) {
    desk.press(stiffBrush(), circle(3));
    desk.edits.cancelPainting();
  }
  ASSERT_TRUE(desk.settle());
  EXPECT_TRUE(desk.status.edits.empty());
}

TEST(EditThread, StrokeInPiecesIsOneEditAndEqualsTheEditor) {
  Desk desk;
  desk.open(oneBall());
  const auto samples = circle(11);
  desk.stroke(stiffBrush(), samples);
  ASSERT_TRUE(desk.settle());
  EXPECT_EQ(desk.status.edits.size(), 1u);
  EXPECT_EQ(desk.status.done, 1u);
  EXPECT_TRUE(desk.status.unsaved);

  Progress progress;
  Editor editor(oneBall(), progress);
  editor.apply(Stroke{stiffBrush(), samples}, progress);
  const auto& made = desk.compiled->scene.objects[0].paint;
  ASSERT_TRUE(made && made->material);
  EXPECT_TRUE(same(*made, *editor.scene().objects[0].paint));
}

TEST(EditThread, ExcessSamplesAreThinnedAndTheLastOneIsKept) {
  Desk desk;
  desk.open(oneBall());
  desk.stroke(stiffBrush(), circle(400, 0, 2));
  ASSERT_TRUE(desk.settle());
  const Scene& scene = desk.compiled->scene;
  ASSERT_TRUE(scene.objects[0].paint);
  const auto& map = *scene.objects[0].paint->material;
  const Material base = baseMaterial(scene.haptics);
  for (const double angle : {0.0, 1.0, 2.0}) {
    const Vec3 p = 0.02 * Vec3(std::cos(angle), std::sin(angle), 0.1).normalized();
    EXPECT_GT(map.at(p, base).stiffness, 800) << angle;
  }
}

TEST(EditThread, ThinningKeepsTheCornersOfAStroke) {
  Desk desk;
  desk.open(oneBall());
  const Brush brush = stiffBrush();
  std::vector<StrokeSample> zigzag;
  for (int i = 0; i <= 400; ++i) {
    const double a = 0.004 * i, b = 0.4 * std::abs((i % 100) / 50.0 - 1);
    zigzag.push_back({i / 120.0, 0.02 * Vec3(std::cos(a), std::sin(a), b).normalized(), 0.5});
  }
  desk.stroke(brush, zigzag);
  ASSERT_TRUE(desk.settle());
  Progress progress;
  Editor every(oneBall(), progress);
  every.apply(Stroke{brush, zigzag}, progress);
  const auto& thinned = *desk.compiled->scene.objects[0].paint->material;
  const auto& all = *every.scene().objects[0].paint->material;
  const Material base = baseMaterial(every.scene().haptics);
  double most = 0;
  for (int i = 0; i < 4000; ++i) {
    const double a = 1.8 * i / 4000 - 0.1, b = 0.6 * std::sin(0.7 * i) + 0.2;
    const Vec3 p = 0.02 * Vec3(std::cos(a), std::sin(a), b).normalized();
    most = std::max(most, std::abs(thinned.at(p, base).stiffness - all.at(p, base).stiffness));
  }
  EXPECT_LT(most, 0.05 * (900 - base.stiffness)); // a hundredth of the radius, on the steep edge
}

TEST(EditThread, DraggedValuesApplyAtOnceAndAreOneEditAtRest) {
  std::atomic<double> felt{0};
  Desk desk({}, [&](const CompiledScene& c) { felt = c.scene.haptics.stiffness; });
  desk.open(oneBall());
  for (int k = 510; k <= 700; k += 10)
    desk.edits.previewValues([k](Scene& scene) { scene.haptics.stiffness = k; });
  ASSERT_TRUE(desk.waitUntil([&] { return felt == 700; }));
  EXPECT_EQ(desk.status.done, 0u);
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 1; }));
  EXPECT_EQ(desk.status.edits.front(), "stiffness = 700");
  EXPECT_EQ(desk.compiled->scene.haptics.stiffness, 700);
}

TEST(EditThread, RevertedValuesAreNoEdit) {
  std::atomic<double> felt{0};
  Desk desk({}, [&](const CompiledScene& c) { felt = c.scene.haptics.stiffness; });
  desk.open(oneBall());
  desk.edits.previewValues([](Scene& scene) { scene.haptics.stiffness = 900; });
  desk.edits.previewValues([](Scene& scene) { scene.haptics.stiffness = 500; });
  ASSERT_TRUE(desk.settle());
  EXPECT_EQ(felt, 500);
  EXPECT_TRUE(desk.status.edits.empty());
}

TEST(EditThread, InvalidValuesAreReportedAndChangeNothing) {
  Desk desk;
  desk.open(oneBall());
  std::string problem;
  desk.edits.previewValues([](Scene& scene) { scene.haptics.stiffness = -1; },
                           [&](const EditOutcome& outcome) { problem = outcome.problem; });
  ASSERT_TRUE(desk.waitUntil([&] { return !problem.empty(); }));
  EXPECT_NE(problem.find("stiffness"), std::string::npos);
  ASSERT_TRUE(desk.settle());
  EXPECT_EQ(desk.compiled->scene.haptics.stiffness, 500);
}

TEST(EditThread, OtherEditsEndTheStrokeFirst) {
  Desk desk;
  desk.open(oneBall());
  desk.press(stiffBrush(), circle(5));
  desk.edits.undo();
  ASSERT_TRUE(desk.settle()); // redoes it
  EXPECT_EQ(desk.status.edits.size(), 1u);
  EXPECT_EQ(desk.status.done, 1u);
  EXPECT_TRUE(desk.problems.empty());
}

TEST(EditThread, HistoryGoesToAnyStepAndBack) {
  Desk desk;
  desk.open(oneBall());
  for (const char* name : {"a", "b", "c"})
    desk.edits.apply(name, [name](const CompiledScene& c) { return renamed(c, name); });
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 3; }));
  EXPECT_EQ(desk.compiled->scene.objects[0].name, "c");
  desk.edits.goTo(1);
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 1; }));
  EXPECT_EQ(desk.compiled->scene.objects[0].name, "a");
  EXPECT_EQ(desk.status.edits.size(), 3u);
  desk.edits.redo();
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 2; }));
  EXPECT_EQ(desk.compiled->scene.objects[0].name, "b");
}

TEST(EditThread, CallsDoNotBlockAndCancelEndsTheCurrentEdit) {
  Desk desk;
  desk.open(oneBall());
  std::optional<EditOutcome> outcome;
  desk.edits.apply(
      "finer",
      [](const CompiledScene& present) {
        auto scene = std::make_shared<Scene>(present.scene);
        scene->field.resolution = 400;
        return scene;
      },
      false, [&](const EditOutcome& said) { outcome = said; });
  desk.stroke(stiffBrush(), circle(5));
  EXPECT_TRUE(desk.edits.busy());
  (void)desk.edits.take();
  EXPECT_FALSE(outcome.has_value()) << "it takes seconds, and is not done";
  ASSERT_TRUE(desk.waitUntil([&] {
    desk.edits.cancel();
    return outcome.has_value();
  }));
  EXPECT_TRUE(outcome->cancelled);
  EXPECT_EQ(outcome->problem, "") << "a cancel is no problem";
  ASSERT_TRUE(desk.settle());
  EXPECT_EQ(desk.compiled->scene.field.resolution, 50);
  EXPECT_TRUE(desk.status.edits.empty()) << "the stroke was waiting, and so was cancelled too";
}

// A ball with the name "a" when saved.
class SavedBall : public testing::Test {
 protected:
  std::filesystem::path workspace() const { return folder.path() / "ws"; }
  std::filesystem::path state() const { return folder.path() / "state"; }
  static void rename(Desk& desk, const std::string& name) {
    desk.edits.apply(name, [name](const CompiledScene& c) { return renamed(c, name); });
  }
  bool save(Desk& desk) const {
    desk.open(oneBall());
    rename(desk, "a");
    desk.edits.saveAs(workspace());
    return desk.waitUntil([&] { return desk.status.folder.has_value(); });
  }
  static bool discard(Desk& desk) {
    bool done = false;
    desk.edits.discard([&](const EditOutcome& outcome) {
      EXPECT_EQ(outcome.problem, "");
      done = outcome.problem.empty() && !outcome.cancelled;
    });
    return desk.waitUntil([&] { return done; });
  }
  void expectA(const Desk& desk) const {
    EXPECT_FALSE(desk.status.unsaved);
    EXPECT_EQ(desk.compiled->scene.objects[0].name, "a");
    EXPECT_EQ(loadWorkspace(workspace()).objects[0].name, "a");
  }
  std::unique_ptr<Editor> openAgain() const {
    Progress progress;
    auto editor = Editor::open(workspace(), {}, progress, {});
    EXPECT_FALSE(editor->unsaved());
    EXPECT_EQ(editor->scene().objects[0].name, "a");
    return editor;
  }

  const Folder folder;
};

TEST_F(SavedBall, DiscardReturnsToTheSavedFolder) {
  Desk desk(state());
  ASSERT_TRUE(save(desk));
  EXPECT_FALSE(desk.status.unsaved);
  EXPECT_TRUE(recoverableScenes(state()).empty());
  rename(desk, "b");
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.unsaved; }));
  ASSERT_TRUE(discard(desk));
  expectA(desk);
}

TEST_F(SavedBall, FullDiskIsAStateUntilAStepIsWritten) {
  Desk desk(state());
  ASSERT_TRUE(save(desk));
  const std::size_t before = desk.status.done;
  std::uintmax_t largest = 0;
  for (const auto& entry : std::filesystem::directory_iterator(workspace()))
    if (entry.path().extension() == ".jsonl") largest = entry.file_size();
  {
    const test::SmallDisk full(largest);
    for (int i = 0; i < 3; ++i) {
      desk.stroke(stiffBrush(), circle(5));
      ASSERT_TRUE(desk.settle());
      EXPECT_EQ(desk.status.done, before);
      EXPECT_NE(desk.status.folder_problem.find("written"), std::string::npos)
          << desk.status.folder_problem;
    }
    EXPECT_TRUE(desk.problems.empty()) << desk.problems.front();
  }
  desk.stroke(stiffBrush(), circle(5));
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == before + 1; }));
  EXPECT_TRUE(desk.status.folder_problem.empty());
}

TEST_F(SavedBall, SavingElsewhereEndsTheStateOfAFullDisk) {
  Desk desk(state());
  ASSERT_TRUE(save(desk));
  {
    const test::SmallDisk full(1);
    rename(desk, "b");
    ASSERT_TRUE(desk.waitUntil([&] { return !desk.status.folder_problem.empty(); }));
  }
  bool done = false;
  desk.edits.saveAs(folder.path() / "elsewhere", [&](const EditOutcome&) { done = true; });
  ASSERT_TRUE(desk.waitUntil([&] { return done && desk.status.folder_problem.empty(); }));
  rename(desk, "c");
  ASSERT_TRUE(desk.waitUntil([&] { return desk.compiled->scene.objects[0].name == "c"; }));
}

TEST_F(SavedBall, IsSavedAgainAfterUndoingAll) {
  {
    Desk desk(state());
    ASSERT_TRUE(save(desk));
    rename(desk, "b");
    ASSERT_TRUE(desk.waitUntil([&] { return desk.status.unsaved; }));
    desk.edits.goTo(1);
    ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 1; }));
    EXPECT_FALSE(desk.status.unsaved);
    desk.edits.goTo(0); // before the saved scene
    ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 0; }));
    EXPECT_TRUE(desk.status.unsaved);
    desk.edits.goTo(1);
    ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 1; }));
  }
  EXPECT_EQ(openAgain()->history().redoable(), 1u) << "and can still be done again";
}

TEST_F(SavedBall, KeepsEditsOfACrashUnsavedUntilUndoneOrDiscarded) {
  {
    Desk desk(state());
    ASSERT_TRUE(save(desk));
    rename(desk, "b");
    ASSERT_TRUE(desk.settle());
  }
  for (const bool discards : {false, true}) {
    Desk desk;
    desk.openFolder(workspace());
    ASSERT_TRUE(desk.settle());
    EXPECT_TRUE(desk.status.unsaved);
    if (discards) {
      ASSERT_TRUE(discard(desk));
      EXPECT_FALSE(desk.status.unsaved);
      continue;
    }
    bool back = false;
    desk.edits.goTo(1, [&](const EditOutcome&) { back = true; });
    ASSERT_TRUE(desk.waitUntil([&] { return back; }));
    EXPECT_FALSE(desk.status.unsaved);
    ASSERT_TRUE(desk.settle()); // redoes all edits
    EXPECT_TRUE(desk.status.unsaved);
  }
  openAgain();
}

TEST_F(SavedBall, IsRestoredEvenIfTheHistoryDroppedTheSavedScene) {
  Desk desk(state());
  ASSERT_TRUE(save(desk));
  desk.edits.goTo(0);
  rename(desk, "b");
  ASSERT_TRUE(desk.settle());
  ASSERT_TRUE(discard(desk));
  expectA(desk);
}

TEST_F(SavedBall, DiscardRestoresTheRedoStepsAndNothingElse) {
  Desk desk(state());
  ASSERT_TRUE(save(desk));
  rename(desk, "b");
  desk.edits.goTo(1);
  bool kept = false;
  desk.edits.save([&](const EditOutcome&) { kept = true; });
  ASSERT_TRUE(desk.waitUntil([&] { return kept; }));
  const std::vector<std::string> saved = desk.status.edits;
  ASSERT_EQ(saved.size(), 2u);
  rename(desk, "c"); // replaces b
  rename(desk, "d");
  ASSERT_TRUE(desk.settle());
  ASSERT_TRUE(discard(desk));
  expectA(desk);
  EXPECT_EQ(desk.status.edits, saved);
  EXPECT_EQ(desk.status.done, 1u);
  desk.edits.redo(); // the saved state, journaled as usual
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 2; }));
  EXPECT_EQ(desk.compiled->scene.objects[0].name, "b");
  EXPECT_TRUE(desk.status.unsaved);
  ASSERT_TRUE(discard(desk));
  expectA(desk);
  const OpenedWorkspace found = openWorkspace(workspace());
  EXPECT_EQ(found.journal.size(), found.event) << "nothing of what was discarded";
}

TEST(EditThread, UncreatableFolderIsReportedAndEditsStay) {
  Desk desk;
  desk.open(oneBall());
  desk.edits.apply("a", [](const CompiledScene& c) { return renamed(c, "a"); });
  std::string problem;
  desk.edits.saveAs("/proc/no/ws", [&](const EditOutcome& outcome) { problem = outcome.problem; });
  ASSERT_TRUE(desk.waitUntil([&] { return !problem.empty(); }));
  EXPECT_NE(problem.find("/proc/no"), std::string::npos) << problem;
  EXPECT_EQ(desk.status.done, 1u);
  EXPECT_TRUE(desk.status.unsaved);
}

TEST(ValueEdits, DifferenceOfTwoScenesTransformsOneIntoTheOther) {
  std::vector<Scene> scenes(8);
  scenes[1].haptics.friction = Friction{0.5, 0.2, 0.1, Friction::SlipDirection::displacement};
  scenes[2].haptics.offset = 1.25e-3;
  scenes[2].haptics.damping = 2;
  scenes[2].haptics.damping_cutoff = 80;
  scenes[3].haptics.magnet = Magnet{1e-3, 250, true};
  scenes[3].haptics.contact = HapticProperties::Contact::ray;
  scenes[4].field.voxel = 5e-4;
  scenes[4].redistance = true;
  scenes[5].field.resolution = 77;
  scenes[5].device = "simulated";
  scenes[5].device_model = DeviceModel{0.1, 0.5, 0.05, 30e-6, 2000, 1};
  scenes[5].stabilisers = Stabilisers{true, false};
  scenes[6].relief = {ReliefMode::baked, ReliefSource::color, -0.7e-3, ForceForm::literal, 2e-4};
  scenes[6].material_form = ForceForm::literal;
  scenes[6].paint_size = 1024;
  scenes[7].haptics.tip_radius = 1.0 / 3e3;
  scenes[7].field.sides = OpenSides::two;
  for (const Scene& before : scenes)
    for (const Scene& after : scenes) {
      const auto edit = valueEdit(before, after);
      ASSERT_EQ(edit.has_value(), &before != &after);
      if (!edit) continue;
      Scene made = before;
      setValues(made, edit->values);
      EXPECT_EQ(values(made), values(after));
      EXPECT_TRUE(made.haptics == after.haptics);
      EXPECT_TRUE(made.relief == after.relief);
      EXPECT_EQ(made.device_model, after.device_model);
    }
}

TEST(ValueEdits, KeepTheLastValueOfEachKey) {
  const ValueEdit both =
      merged({{{"stiffness", "600"}, {"damping", "1"}}}, {{{"stiffness", "700"}}});
  EXPECT_EQ(both.values, (ValueEdit{{{"damping", "1"}, {"stiffness", "700"}}}.values));
}

} // namespace
} // namespace patina
