// Edits on a thread of their own: order, what becomes one edit, and that nobody waits.
#include "session/edit/edit_thread.h"

#include <gtest/gtest.h>

#include "app/edit_desk.h"
#include "session/edit/editor.h"
#include "session/edit/value_edit.h"
#include "support/sanitized.h"
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

TEST(EditThread, AStrokeInPiecesIsOneEditAndPaintsWhatTheEditorPaints) {
  Desk desk;
  desk.open(oneBall());
  const auto samples = circle(11);
  desk.edits.beginStroke(stiffBrush());
  desk.edits.dabs({samples.begin(), samples.begin() + 3});
  desk.edits.dabs({samples.begin() + 3, samples.end()});
  desk.edits.endStroke();
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

TEST(EditThread, MoreSamplesThanCanBePaintedAreThinnedAndTheLastOneCounts) {
  Desk desk;
  desk.open(oneBall());
  desk.edits.beginStroke(stiffBrush());
  desk.edits.dabs(circle(400, 0, 2));
  desk.edits.endStroke();
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

TEST(EditThread, WhatIsThinnedOutLeavesTheCornersOfAStroke) {
  Desk desk;
  desk.open(oneBall());
  const Brush brush = stiffBrush();
  std::vector<StrokeSample> zigzag;
  for (int i = 0; i <= 400; ++i) {
    const double a = 0.004 * i, b = 0.4 * std::abs((i % 100) / 50.0 - 1);
    zigzag.push_back({i / 120.0, 0.02 * Vec3(std::cos(a), std::sin(a), b).normalized(), 0.5});
  }
  desk.edits.beginStroke(brush);
  desk.edits.dabs(zigzag);
  desk.edits.endStroke();
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
  EXPECT_LT(most, 0.05 * (900 - base.stiffness)); // a hundredth of the radius, on the steep rim
}

TEST(EditThread, DraggedValuesAreFeltAtOnceAndAreOneEditWhenTheyRest) {
  std::atomic<double> felt{0};
  Desk desk({}, [&](const CompiledScene& c) { felt = c.scene.haptics.stiffness; });
  desk.open(oneBall());
  for (int k = 510; k <= 700; k += 10)
    desk.edits.tryValues([k](Scene& scene) { scene.haptics.stiffness = k; });
  ASSERT_TRUE(desk.waitUntil([&] { return felt == 700; }));
  EXPECT_EQ(desk.status.done, 0u);
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 1; }));
  EXPECT_EQ(desk.status.edits.front(), "stiffness = 700");
  EXPECT_EQ(desk.compiled->scene.haptics.stiffness, 700);
}

TEST(EditThread, ValuesThatComeBackToWhereTheyWereAreNoEdit) {
  std::atomic<double> felt{0};
  Desk desk({}, [&](const CompiledScene& c) { felt = c.scene.haptics.stiffness; });
  desk.open(oneBall());
  desk.edits.tryValues([](Scene& scene) { scene.haptics.stiffness = 900; });
  desk.edits.tryValues([](Scene& scene) { scene.haptics.stiffness = 500; });
  ASSERT_TRUE(desk.settle());
  EXPECT_EQ(felt, 500);
  EXPECT_TRUE(desk.status.edits.empty());
}

TEST(EditThread, ValuesThatMakeNoSenseAreToldOfAndChangeNothing) {
  Desk desk;
  desk.open(oneBall());
  std::string problem;
  desk.edits.tryValues([](Scene& scene) { scene.haptics.stiffness = -1; },
                       [&](const EditOutcome& outcome) { problem = outcome.problem; });
  ASSERT_TRUE(desk.waitUntil([&] { return !problem.empty(); }));
  EXPECT_NE(problem.find("stiffness"), std::string::npos);
  ASSERT_TRUE(desk.settle());
  EXPECT_EQ(desk.compiled->scene.haptics.stiffness, 500);
}

TEST(EditThread, AnythingElseEndsTheStrokeFirst) {
  Desk desk;
  desk.open(oneBall());
  desk.edits.beginStroke(stiffBrush());
  desk.edits.dabs(circle(5));
  desk.edits.undo();
  desk.edits.dabs(circle(5)); // of no stroke
  ASSERT_TRUE(desk.settle()); // which redoes it
  EXPECT_EQ(desk.status.edits.size(), 1u);
  EXPECT_EQ(desk.status.done, 1u);
  EXPECT_TRUE(desk.problems.empty());
}

TEST(EditThread, TheHistoryGoesToAnyStepAndBack) {
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

TEST(EditThread, NoCallWaitsForWhatIsUnderWayAndCancelEndsIt) {
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
  desk.edits.beginStroke(stiffBrush());
  desk.edits.dabs(circle(5));
  desk.edits.endStroke();
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

// A ball, named "a" when it was saved.
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

TEST_F(SavedBall, HasAFolderAndDiscardingGoesBackToIt) {
  Desk desk(state());
  ASSERT_TRUE(save(desk));
  EXPECT_FALSE(desk.status.unsaved);
  EXPECT_TRUE(leftBehind(state()).empty());
  rename(desk, "b");
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.unsaved; }));
  ASSERT_TRUE(discard(desk));
  expectA(desk);
}

TEST_F(SavedBall, IsSavedAgainOnceAllIsTakenBack) {
  {
    Desk desk(state());
    ASSERT_TRUE(save(desk));
    rename(desk, "b");
    ASSERT_TRUE(desk.waitUntil([&] { return desk.status.unsaved; }));
    desk.edits.goTo(1);
    ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 1; }));
    EXPECT_FALSE(desk.status.unsaved);
    desk.edits.goTo(0); // before what was saved
    ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 0; }));
    EXPECT_TRUE(desk.status.unsaved);
    desk.edits.goTo(1);
    ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 1; }));
  }
  EXPECT_EQ(openAgain()->history().redoable(), 1u) << "and can still be done again";
}

TEST_F(SavedBall, HasEditsOfACrashUnsavedUntilTheyAreTakenBackOrDiscarded) {
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
    ASSERT_TRUE(desk.settle()); // which does all of it again
    EXPECT_TRUE(desk.status.unsaved);
  }
  openAgain();
}

TEST_F(SavedBall, ComesBackThoughTheHistoryHasLeftWhatWasSaved) {
  Desk desk(state());
  ASSERT_TRUE(save(desk));
  desk.edits.goTo(0);
  rename(desk, "b");
  ASSERT_TRUE(desk.settle());
  ASSERT_TRUE(discard(desk));
  expectA(desk);
}

TEST_F(SavedBall, DiscardingGivesBackWhatWasToBeRedoneAndNothingElse) {
  Desk desk(state());
  ASSERT_TRUE(save(desk));
  rename(desk, "b");
  desk.edits.goTo(1);
  bool kept = false;
  desk.edits.save([&](const EditOutcome&) { kept = true; });
  ASSERT_TRUE(desk.waitUntil([&] { return kept; }));
  const std::vector<std::string> saved = desk.status.edits;
  ASSERT_EQ(saved.size(), 2u);
  rename(desk, "c"); // in the place of b
  rename(desk, "d");
  ASSERT_TRUE(desk.settle());
  ASSERT_TRUE(discard(desk));
  expectA(desk);
  EXPECT_EQ(desk.status.edits, saved);
  EXPECT_EQ(desk.status.done, 1u);
  desk.edits.redo(); // what was saved, and journaled as ever
  ASSERT_TRUE(desk.waitUntil([&] { return desk.status.done == 2; }));
  EXPECT_EQ(desk.compiled->scene.objects[0].name, "b");
  EXPECT_TRUE(desk.status.unsaved);
  ASSERT_TRUE(discard(desk));
  expectA(desk);
  const OpenedWorkspace found = openWorkspace(workspace());
  EXPECT_EQ(found.journal.size(), found.event) << "nothing of what was discarded";
}

TEST(EditThread, AFolderThatCannotBeMadeIsToldOfAndTheEditsStay) {
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

TEST(ValueEdits, TheDifferenceOfTwoScenesMakesOneOfTheOther) {
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
  scenes[6].relief = {ReliefMode::baked, ReliefFrom::color, -0.7e-3, ForceForm::literal, 2e-4};
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

TEST(ValueEdits, OfEachKeyTheLastValueStays) {
  const ValueEdit both =
      merged({{{"stiffness", "600"}, {"damping", "1"}}}, {{{"stiffness", "700"}}});
  EXPECT_EQ(both.values, (ValueEdit{{{"damping", "1"}, {"stiffness", "700"}}}.values));
}

} // namespace
} // namespace patina
