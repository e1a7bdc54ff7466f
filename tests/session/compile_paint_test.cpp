// Haptic effect of a scene's paint, parts shared between versions, and absent parts.
#include "session/compile/compile_paint.h"

#include <gtest/gtest.h>

#include "session/edit/editor.h"
#include "session/painted_scenes.h"

namespace patina {
namespace {

using namespace test;

class HapticPaints : public testing::Test {
 protected:
  Progress progress;
};

TEST_F(HapticPaints, AreAbsentWithoutPaint) {
  const auto compiled = compile(ballScene(), progress);
  EXPECT_TRUE(compiled->paint.objects.empty());
  EXPECT_TRUE(compiled->paint.relief.empty());
  EXPECT_EQ(compiled->paint.bake, nullptr);
  EXPECT_EQ(compiled->paint.field, compiled->built.field);
  EXPECT_EQ(compiled->paint.bytes(), 0U);
}

TEST_F(HapticPaints, ColorAloneHasNoHapticEffect) {
  Editor editor(ballScene(), progress);
  editor.apply(dabAt(Tool::color, 0, 0.01, Vec3(0, 0, kBall)), progress);
  ASSERT_TRUE(editor.scene().objects[0].paint->color);
  EXPECT_TRUE(editor.compiled()->paint.objects.empty());
  EXPECT_EQ(editor.compiled()->snapshot->stages.size(),
            compile(ballScene(), progress)->snapshot->stages.size());
}

TEST_F(HapticPaints, VersionsShareUnchangedParts) {
  Editor editor(ballScene(), progress);
  editor.apply(dabAt(Tool::material(MaterialChannel::stiffness), 900, 0.01, Vec3(0, 0, kBall)),
               progress);
  editor.apply(dabAt(Tool::relief, 5e-4, 0.01, Vec3(kBall, 0, 0)), progress);
  const auto before = editor.compiled();
  ASSERT_EQ(before->paint.objects.size(), 1U);
  ASSERT_TRUE(before->paint.objects[0].material);
  ASSERT_TRUE(before->paint.objects[0].relief);
  EXPECT_EQ(before->paint.field, before->built.field); // pulled relief is not baked
  // A value that does not affect paint keeps all of it.
  editor.apply(ValueEdit{{{"force.limit", "2"}}}, progress);
  EXPECT_EQ(editor.compiled()->paint.objects[0].material, before->paint.objects[0].material);
  EXPECT_EQ(editor.compiled()->built.field, before->built.field);
  // Relief elsewhere keeps the material; the faces are built once per layout.
  editor.apply(dabAt(Tool::relief, 5e-4, 0.01, Vec3(-kBall, 0, 0)), progress);
  EXPECT_EQ(editor.compiled()->paint.objects[0].material, before->paint.objects[0].material);
  EXPECT_EQ(editor.compiled()->paint.objects[0].relief->faces,
            before->paint.objects[0].relief->faces);
  // A new base shows through thin paint, so the map is computed again.
  editor.apply(ValueEdit{{{"stiffness", "300"}}}, progress);
  EXPECT_NE(editor.compiled()->paint.objects[0].material, before->paint.objects[0].material);
}

TEST_F(HapticPaints, IncrementalUpdatesEqualOneCompile) {
  for (const char* mode : {"pulled", "baked"}) {
    Scene scene = ballScene();
    setValue(scene, "relief.mode", mode);
    Editor editor(scene, progress);
    for (const Stroke& one : manyStrokes(12)) editor.apply(one, progress);
    const auto whole = compile(editor.scene(), progress);
    const auto& stepwise = *editor.compiled();
    ASSERT_EQ(whole->built.field->grid.voxel, stepwise.built.field->grid.voxel);
    EXPECT_TRUE(feelAlike(*whole->snapshot, *stepwise.snapshot)) << mode;
  }
}

// F7: data for planning a lateral coupling, dab by dab, and only if one may be planned.
TEST_F(HapticPaints, ReliefCurvatureIsComputedIfThereIsADevice) {
  Editor editor(ballScene(), progress);
  editor.apply(dabAt(Tool::relief, 5e-4, 0.006, Vec3(kBall, 0, 0)), progress);
  EXPECT_EQ(editor.compiled()->paint.objects[0].max_curvature, 0);
  EXPECT_FALSE(editor.compiled()->paint.relief[0].curvature_map);
  editor.apply(ValueEdit{{{"device.mass", "0.1"}}}, progress);
  for (const double angle : {0.0, 0.1, 2.0}) {
    const Vec3 place = kBall * Vec3(std::cos(angle), std::sin(angle), 0);
    editor.apply(dabAt(Tool::relief, 5e-4, 0.004, place), progress);
    const CompiledScene& compiled = *editor.compiled();
    const SceneObject& object = compiled.scene.objects[0];
    const ReliefLimit limit =
        reliefLimit(*compiled.objects[0]->mesh, object.paint->layout,
                    *compiled.paint.relief[0].felt, compiled.scene.relief.height,
                    compiled.scene.device_model, compiled.scene.haptics.force_limit);
    EXPECT_GT(limit.curvature, 0);
    EXPECT_EQ(compiled.paint.objects[0].max_curvature, limit.curvature);
    EXPECT_EQ(compiled.snapshot->stabilisers.lateral.has_value(),
              limit.curvature > maxStableCurvature(compiled.scene.haptics.force_limit,
                                                   *compiled.scene.device_model));
  }
}

TEST_F(HapticPaints, SmoothedReliefIsLowerAndTheImageUnchanged) {
  Editor editor(ballScene(), progress);
  editor.apply(dabAt(Tool::relief, 5e-4, 0.004, Vec3(0, 0, kBall)), progress);
  const auto image = editor.scene().objects[0].paint->relief;
  const double highest = editor.compiled()->paint.objects[0].highest;
  EXPECT_GE(highest, 4.99e-4);
  EXPECT_LE(highest, 6.4e-4); // what lies between texels may be higher by 1/8 along either axis
  editor.apply(ValueEdit{{{"relief.smoothing", "4mm"}}}, progress);
  EXPECT_EQ(editor.scene().objects[0].paint->relief, image);
  EXPECT_LT(editor.compiled()->paint.objects[0].highest, 0.8 * highest);
  EXPECT_GT(editor.compiled()->paint.objects[0].highest, 1e-5);
  editor.apply(ValueEdit{{{"relief.smoothing", "none"}}}, progress);
  EXPECT_EQ(editor.compiled()->paint.relief[0].felt, image);
}

TEST_F(HapticPaints, ChangesNameExactlyTheDifferences) {
  Editor editor(ballScene(), progress);
  const Scene start = editor.scene();
  EXPECT_TRUE(paintChanges(start, start).empty());
  editor.apply(dabAt(Tool::material(MaterialChannel::stiffness), 900, 0.006, Vec3(0, 0, kBall)),
               progress);
  const Scene material = editor.scene();
  editor.apply(dabAt(Tool::relief, 5e-4, 0.006, Vec3(kBall, 0, 0)), progress);
  const std::vector<PaintChange> first = paintChanges(start, material);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_FALSE(first[0].images);
  EXPECT_EQ(first[0].material_blocks.size(), material.objects[0].paint->material->blocks().size());
  for (const auto& pair : {std::pair{material, editor.scene()}, {editor.scene(), material}}) {
    const std::vector<PaintChange> second = paintChanges(pair.first, pair.second);
    ASSERT_EQ(second.size(), 1U);
    EXPECT_TRUE(second[0].material_blocks.empty());
    EXPECT_TRUE(second[0].images);
  }
}

// F8's scene: relief extends the surface, and the band is widened to hold it.
TEST_F(HapticPaints, HighReliefWidensTheBand) {
  Scene scene = ballScene();
  const auto flat = compile(scene, progress);
  Editor editor(scene, progress);
  editor.apply(dabAt(Tool::relief, 8e-3, 0.01, Vec3(0, 0, kBall)), progress);
  const auto compiled = compile(editor.scene(), progress);
  EXPECT_GE(interactionRange(editor.scene()).length(), 7.99e-3);
  EXPECT_GE(compiled->band * compiled->built.field->grid.voxel, 8e-3);
  EXPECT_GT(compiled->band, flat->band);
}

// K21: bright is high, and neither black nor unpainted texels change anything.
TEST_F(HapticPaints, ReliefIsTheGreyOfTheColorIfTheSceneSelectsIt) {
  for (const char* mode : {"pulled", "baked"}) {
    Scene scene = ballScene();
    setValues(scene, {{"relief.mode", mode}, {"relief.height", "0.4mm"}});
    Editor editor(scene, progress);
    Stroke stroke = dabAt(Tool::color, 0, 0.008, Vec3(0, 0, kBall));
    stroke.brush.falloff = 50;
    stroke.brush.color = {0.2, 0.9, 0.4};
    editor.apply(stroke, progress);
    EXPECT_TRUE(editor.compiled()->paint.objects.empty()); // colour alone has no haptic effect
    editor.apply(ValueEdit{{{"relief.source", "color"}}}, progress);
    const double luma = 0.2126 * 0.2 + 0.7152 * 0.9 + 0.0722 * 0.4;
    const auto& felt = editor.compiled()->paint.relief.at(0).felt;
    const TiledImage& color = *editor.scene().objects[0].paint->color;
    for (int j = 0; j < color.height(); ++j)
      for (int i = 0; i < color.width(); ++i)
        ASSERT_NEAR(static_cast<double>(felt->at(i, j, 0)),
                    luma * static_cast<double>(color.at(i, j, 3)), 1e-6);
    EXPECT_FALSE(editor.scene().objects[0].paint->relief); // nothing is painted as relief

    // The tip is held 0.4 mm * luma farther out, apart from the radius of the field.
    ContactMemory memory;
    const Vec3 tip(0, 0, kBall - 5e-4);
    const double with = tick(*editor.compiled()->snapshot, memory, tip, 1e-3).force.z();
    ContactMemory bare;
    const double without = tick(*compile(scene, progress)->snapshot, bare, tip, 1e-3).force.z();
    EXPECT_NEAR((with - without) / scene.haptics.stiffness, 4e-4 * luma, 0.02 * 4e-4) << mode;

    // Each dab takes effect at once, with the result of compile().
    for (Stroke one : manyStrokes(9, 4)) {
      one.brush.color = {0.1 * static_cast<double>(one.samples.size()), 0.8, 0.3};
      editor.apply(one, progress);
    }
    const auto whole = compile(editor.scene(), progress);
    EXPECT_TRUE(feelAlike(*whole->snapshot, *editor.compiled()->snapshot)) << mode;
    EXPECT_TRUE(same(*whole->paint.relief[0].felt, *editor.compiled()->paint.relief[0].felt));

    editor.apply(ValueEdit{{{"relief.source", "painted"}}}, progress);
    EXPECT_TRUE(editor.compiled()->paint.relief.at(0).felt ==
                editor.scene().objects[0].paint->relief);
  }
}

TEST_F(HapticPaints, BlackGivesNoRelief) { // T-K21d
  Scene scene = ballScene();
  setValue(scene, "relief.source", "color");
  Editor editor(scene, progress);
  Stroke stroke = dabAt(Tool::color, 0, 0.01, Vec3(0, 0, kBall));
  stroke.brush.color = {0, 0, 0};
  editor.apply(stroke, progress);
  EXPECT_TRUE(feelAlike(*editor.compiled()->snapshot, *compile(ballScene(), progress)->snapshot));
}

// The history has one entry, which is undone, redone and replayed to the same bits.
TEST_F(HapticPaints, LayersOfAStrokeAreOneEdit) {
  Editor editor(ballScene(), progress);
  Stroke stroke = dabAt(Tool::material(MaterialChannel::stiffness), 900, 0.008, Vec3(0, 0, kBall));
  for (const Tool tool :
       {Tool::color, Tool::relief, Tool::material(MaterialChannel::static_friction)})
    stroke.brush.extra_layers.push_back({tool, {0.2, 0.4, 0.6}, tool == Tool::relief ? 3e-4 : 0.5});
  editor.apply(stroke, progress);
  EXPECT_EQ(editor.history().undoable(), 1U);
  const ObjectPaint paint = *editor.scene().objects[0].paint;
  EXPECT_TRUE(paint.color && paint.relief);
  EXPECT_TRUE(paint.material->has(MaterialChannel::stiffness));
  EXPECT_TRUE(paint.material->has(MaterialChannel::static_friction));
  EXPECT_EQ(editor.undo(1, progress), 1U);
  EXPECT_FALSE(editor.scene().objects[0].paint);
  EXPECT_EQ(editor.redo(1, progress), 1U);
  EXPECT_TRUE(same(*editor.scene().objects[0].paint, paint));
}

} // namespace
} // namespace patina
