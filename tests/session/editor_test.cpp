// The editor: effects on the scene, notices and undo.
#include "session/edit/editor.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "core/error.h"
#include "session/painted_scenes.h"

namespace patina {
namespace {

using namespace test;

class Editors : public testing::Test {
 protected:
  Progress progress;
};

TEST_F(Editors, EveryStrokeIsOneEditAndUndoIsBitwise) {
  Editor editor(ballScene(), progress);
  std::vector<Scene> scenes{editor.scene()};
  for (const Stroke& one : manyStrokes(24)) {
    const std::size_t before = editor.history().undoable();
    editor.apply(one, progress);
    if (editor.history().undoable() > before) scenes.push_back(editor.scene());
  }
  ASSERT_GT(scenes.size(), 15U);
  for (std::size_t i = scenes.size() - 1; i-- > 0;) {
    ASSERT_EQ(editor.undo(1, progress), 1U);
    ASSERT_TRUE(same(editor.scene(), scenes[i])) << i;
  }
  EXPECT_EQ(editor.undo(1, progress), 0U);
  EXPECT_EQ(editor.redo(1000, progress), scenes.size() - 1);
  EXPECT_TRUE(same(editor.scene(), scenes.back()));
}

// A budget of zero makes the history replay all of the past, to the same bits.
TEST_F(Editors, ReplayIsBitwiseEqual) {
  const std::vector<Stroke> strokes = manyStrokes(24);
  Editor ample(ballScene(), progress);
  Editor sparing(ballScene(), progress, {}, 1);
  std::vector<Scene> scenes;
  for (const Stroke& one : strokes) {
    ample.apply(one, progress);
    sparing.apply(one, progress);
  }
  ASSERT_LT(sparing.history().scenes(), 4U);
  ASSERT_EQ(sparing.history().undoable(), ample.history().undoable());
  const std::size_t edits = ample.history().undoable();
  for (std::size_t i = 0; i <= edits; i += 3)
    EXPECT_TRUE(same(sparing.history().sceneAt(i), ample.history().sceneAt(i))) << i;
  sparing.undo(edits, progress);
  EXPECT_TRUE(same(sparing.scene(), ballScene()));
}

// The field in use may be wider or older; the field for painting is always the same.
TEST_F(Editors, LaterValuesDoNotMoveTheGrid) {
  const std::vector<Stroke> strokes = manyStrokes(16);
  Editor plain(ballScene(), progress);
  Editor eventful(ballScene(), progress);
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (i == 0) eventful.apply(ValueEdit{{{"offset", "9mm"}}}, progress); // a wider band
    if (i == 9) eventful.apply(ValueEdit{{{"offset", "none"}}}, progress);
    if (i == 12) eventful.apply(ValueEdit{{{"voxel", "0.5mm"}}}, progress);
    if (i == 12) eventful.apply(ValueEdit{{{"resolution", "60"}}}, progress);
    plain.apply(strokes[i], progress);
    eventful.apply(strokes[i], progress);
  }
  EXPECT_TRUE(same(plain.scene(), eventful.scene()));
}

TEST_F(Editors, DabIsPublishedOnReturnAndReportsItsChanges) {
  std::vector<EditorNotice> notices;
  Editor editor(ballScene(), progress,
                [&](const EditorNotice& notice) { notices.push_back(notice); });
  const auto before = editor.compiled();
  editor.beginStroke(
      dabAt(Tool::material(MaterialChannel::stiffness), 900, 0.01, Vec3::Zero()).brush, progress);
  EXPECT_TRUE(editor.inStroke());
  EXPECT_TRUE(notices.empty());
  const PaintReport report = editor.dab({0, Vec3(0, 0, kBall), 0.5});
  EXPECT_GT(report.nodes, 0U);
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_EQ(notices[0].compiled, editor.compiled());
  ASSERT_TRUE(notices[0].changes);
  ASSERT_EQ(notices[0].changes->size(), 1U);
  EXPECT_FALSE(notices[0].changes->front().material_blocks.empty());
  EXPECT_FALSE(feelAlike(*before->snapshot, *editor.compiled()->snapshot));
  EXPECT_EQ(editor.compiled()->built.field, before->built.field); // the field is reused
  EXPECT_TRUE(editor.endStroke());
  EXPECT_EQ(editor.history().undoable(), 1U);
}

TEST_F(Editors, CancelledStrokeLeavesNoTrace) {
  Editor editor(ballScene(), progress);
  editor.apply(dabAt(Tool::relief, 3e-4, 0.01, Vec3(0, 0, kBall)), progress);
  const Scene before = editor.scene();
  const auto snapshot = editor.compiled()->snapshot;
  editor.beginStroke(dabAt(Tool::relief, 5e-4, 0.01, Vec3::Zero()).brush, progress);
  editor.dab({0, Vec3(0, 0, kBall), 0});
  EXPECT_FALSE(same(editor.scene(), before));
  editor.cancelStroke();
  EXPECT_FALSE(editor.inStroke());
  EXPECT_TRUE(same(editor.scene(), before));
  EXPECT_EQ(editor.compiled()->snapshot, snapshot);
  EXPECT_EQ(editor.history().undoable(), 1U);
}

TEST_F(Editors, StrokeWithoutContactIsNoEdit) {
  Editor editor(ballScene(), progress);
  editor.beginStroke(dabAt(Tool::relief, 5e-4, 0.01, Vec3::Zero()).brush, progress);
  EXPECT_EQ(editor.dab({0, Vec3(0, 0, 1), 0}).missed, 1U);
  EXPECT_FALSE(editor.endStroke());
  EXPECT_EQ(editor.history().undoable(), 0U);
}

TEST_F(Editors, StrokeThatPaintsWhatIsThereIsNoEdit) {
  Editor editor(ballScene(), progress);
  for (const Tool tool :
       {Tool{Tool::color}, Tool{Tool::relief}, Tool::material(MaterialChannel::stiffness)}) {
    Stroke stroke = dabAt(tool, 5e-4, 0.01, Vec3(0, 0, kBall));
    stroke.brush.falloff = 1e6; // full weight up to the edge, for what is half covered gets more
    editor.apply(stroke, progress);
    const std::size_t edits = editor.history().undoable();
    const Scene before = editor.scene();
    editor.apply(stroke, progress);
    EXPECT_TRUE(same(editor.scene(), before));
    EXPECT_EQ(editor.history().undoable(), edits);
  }
}

// A device that loses its position for a moment or restarts does not end the stroke.
TEST_F(Editors, RecordedStrokeCanBeReplayed) {
  Editor editor(ballScene(), progress);
  const Scene before = editor.scene();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  editor.beginStroke(
      dabAt(Tool::material(MaterialChannel::stiffness), 900, 0.005, Vec3::Zero()).brush, progress);
  editor.dab({5, Vec3(0, 0, kBall), 0.5});
  EXPECT_EQ(editor.dab({5.1, Vec3(nan, 0, 0), 0.5}).missed, 1U);
  editor.dab({nan, Vec3(0, 0, kBall), 0.5});
  editor.dab({0, Vec3(0.002, 0, kBall), 0.5}); // its clock began again
  editor.dab({0.1, Vec3(0.004, 0, kBall), -0.5});
  ASSERT_TRUE(editor.endStroke());
  const auto& stroke = std::get<Stroke>(editor.history().edit(0));
  EXPECT_EQ(stroke.samples.size(), 3U);
  Editor again(before, progress);
  again.apply(stroke, progress); // throws if it makes no sense
  EXPECT_TRUE(same(again.scene(), editor.scene()));
}

// No part of relief that exceeds every field may reach the history.
TEST_F(Editors, StrokeThatCannotBePublishedIsNotStarted) {
  Scene scene = ballScene();
  scene.objects[0].mesh = std::make_shared<const TriangleMesh>(icosphere(3e-3, 12));
  scene.field.voxel = 0.06e-3; // 0.1 m of relief beyond it are more nodes than a grid may have
  Editor editor(scene, progress);
  EXPECT_THROW(editor.beginStroke(dabAt(Tool::relief, 0.1, 1e-3, Vec3::Zero()).brush, progress),
               Error);
  EXPECT_FALSE(editor.inStroke());
  EXPECT_TRUE(same(editor.scene(), scene));
  EXPECT_EQ(editor.history().undoable(), 0U);
}

// A field that must grow is built before the first dab, and its voxel stays.
TEST_F(Editors, BandIsWidenedForTallReliefBeforeTheFirstDab) {
  Editor editor(ballScene(), progress);
  const double voxel = editor.compiled()->built.field->grid.voxel;
  const Stroke tall = dabAt(Tool::relief, 6e-3, 0.004, Vec3(0, 0, kBall));
  editor.beginStroke(tall.brush, progress);
  const auto field = editor.compiled()->built.field;
  EXPECT_DOUBLE_EQ(field->grid.voxel, voxel);
  (void)editor.dab(tall.samples[0]);
  EXPECT_EQ(editor.compiled()->built.field, field);
  (void)editor.endStroke();
  EXPECT_EQ(editor.compiled()->built.field, field);
}

TEST_F(Editors, OtherEditsWaitForTheStrokeToEnd) {
  Editor editor(ballScene(), progress);
  editor.beginStroke(dabAt(Tool::relief, 5e-4, 0.01, Vec3::Zero()).brush, progress);
  EXPECT_THROW(editor.beginStroke(Brush{}, progress), std::invalid_argument);
  EXPECT_THROW(editor.apply(ValueEdit{{{"stiffness", "1"}}}, progress), std::invalid_argument);
  EXPECT_THROW(editor.undo(1, progress), std::invalid_argument);
  EXPECT_THROW(editor.redo(1, progress), std::invalid_argument);
  editor.cancelStroke();
  EXPECT_THROW(editor.dab({}), std::invalid_argument);
  EXPECT_THROW(editor.endStroke(), std::invalid_argument);
}

TEST_F(Editors, InvalidEditsChangeNothing) {
  Editor editor(ballScene(), progress);
  const auto before = editor.compiled();
  EXPECT_THROW(editor.apply(ValueEdit{{{"stiffness", "-1"}}}, progress), Error);
  EXPECT_THROW(editor.apply(ValueEdit{{{"no.such", "1"}}}, progress), Error);
  Stroke bad = dabAt(Tool::relief, 1e-3, -1, Vec3(0, 0, kBall));
  EXPECT_THROW(editor.apply(bad, progress), Error);
  EXPECT_THROW(editor.apply(SceneEdit{"nothing", nullptr}, progress), std::invalid_argument);
  EXPECT_EQ(editor.compiled(), before);
  EXPECT_EQ(editor.history().undoable(), 0U);
  EXPECT_FALSE(editor.inStroke());
}

TEST_F(Editors, UndoAddsAndRemovesObjects) {
  Editor editor(ballScene(), progress);
  editor.apply(dabAt(Tool::material(MaterialChannel::stiffness), 900, 0.01, Vec3(0, 0, kBall)),
               progress);
  const Scene one = editor.scene();
  Scene two = one;
  two.objects.push_back(ballScene().objects[0]);
  two.objects[1].name = "other";
  two.objects[1].world_from_object.translation() = Vec3(0.08, 0, 0);
  editor.apply(SceneEdit{"add other", std::make_shared<const Scene>(two)}, progress);
  editor.apply(dabAt(Tool::material(MaterialChannel::stiffness), 200, 0.01, Vec3(0.08, 0, kBall)),
               progress);
  ASSERT_TRUE(editor.scene().objects[1].paint);
  EXPECT_TRUE(same(*editor.scene().objects[0].paint, *one.objects[0].paint));
  const Scene painted = editor.scene();
  EXPECT_EQ(editor.undo(2, progress), 2U);
  EXPECT_TRUE(same(editor.scene(), one));
  EXPECT_EQ(editor.compiled()->objects.size(), 1U);
  EXPECT_EQ(editor.redo(2, progress), 2U);
  EXPECT_TRUE(same(editor.scene(), painted));
}

} // namespace
} // namespace patina
