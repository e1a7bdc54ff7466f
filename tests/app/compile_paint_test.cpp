// What of a scene's paint is felt, what is kept between versions, and what is absent.
#include "app/compile_paint.h"

#include <gtest/gtest.h>

#include "app/editor.h"
#include "app/painted_scenes.h"

namespace patina {
namespace {

using namespace test;

class FeltPaints : public testing::Test {
 protected:
  Progress progress;
};

TEST_F(FeltPaints, AreAbsentWhereNothingIsPainted) {
  const auto compiled = compile(ballScene(), progress);
  EXPECT_TRUE(compiled->paint.objects.empty());
  EXPECT_TRUE(compiled->paint.relief.empty());
  EXPECT_EQ(compiled->paint.bake, nullptr);
  EXPECT_EQ(compiled->paint.field, compiled->built.field);
  EXPECT_EQ(compiled->paint.bytes(), 0U);
}

TEST_F(FeltPaints, ColourAloneIsNotFelt) {
  Editor editor(ballScene(), progress);
  editor.apply(dabAt(Tool::color, 0, 0.01, Vec3(0, 0, kBall)), progress);
  ASSERT_TRUE(editor.scene().objects[0].paint->color);
  EXPECT_TRUE(editor.compiled()->paint.objects.empty());
  EXPECT_EQ(editor.compiled()->snapshot->stages.size(),
            compile(ballScene(), progress)->snapshot->stages.size());
}

TEST_F(FeltPaints, VersionsShareWhatDidNotChange) {
  Editor editor(ballScene(), progress);
  editor.apply(dabAt(Tool::stiffness, 900, 0.01, Vec3(0, 0, kBall)), progress);
  editor.apply(dabAt(Tool::relief, 5e-4, 0.01, Vec3(kBall, 0, 0)), progress);
  const auto before = editor.compiled();
  ASSERT_EQ(before->paint.objects.size(), 1U);
  ASSERT_TRUE(before->paint.objects[0].material);
  ASSERT_TRUE(before->paint.objects[0].relief);
  EXPECT_EQ(before->paint.field, before->built.field); // pulled: nothing is baked
  // A value that paint has nothing to do with keeps all of it.
  editor.apply(ValueEdit{{{"force.limit", "2"}}}, progress);
  EXPECT_EQ(editor.compiled()->paint.objects[0].material, before->paint.objects[0].material);
  EXPECT_EQ(editor.compiled()->built.field, before->built.field);
  // Relief elsewhere keeps material; faces are made once for a layout.
  editor.apply(dabAt(Tool::relief, 5e-4, 0.01, Vec3(-kBall, 0, 0)), progress);
  EXPECT_EQ(editor.compiled()->paint.objects[0].material, before->paint.objects[0].material);
  EXPECT_EQ(editor.compiled()->paint.objects[0].relief->faces,
            before->paint.objects[0].relief->faces);
  // Another base is felt where paint is thin: made anew.
  editor.apply(ValueEdit{{{"stiffness", "300"}}}, progress);
  EXPECT_NE(editor.compiled()->paint.objects[0].material, before->paint.objects[0].material);
}

TEST_F(FeltPaints, MadeStepByStepTheyAreWhatCompileMakesAtOnce) {
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

TEST_F(FeltPaints, SmoothedReliefIsLowerAndTheImageStays) {
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

TEST_F(FeltPaints, ChangesNameWhatDiffersAndNothingElse) {
  Editor editor(ballScene(), progress);
  const Scene start = editor.scene();
  EXPECT_TRUE(paintChanges(start, start).empty());
  editor.apply(dabAt(Tool::stiffness, 900, 0.006, Vec3(0, 0, kBall)), progress);
  const Scene material = editor.scene();
  editor.apply(dabAt(Tool::relief, 5e-4, 0.006, Vec3(kBall, 0, 0)), progress);
  const std::vector<PaintChange> first = paintChanges(start, material);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_TRUE(first[0].relief_tiles.empty());
  EXPECT_EQ(first[0].material_blocks.size(), material.objects[0].paint->material->blocks().size());
  for (const auto& pair : {std::pair{material, editor.scene()}, {editor.scene(), material}}) {
    const std::vector<PaintChange> second = paintChanges(pair.first, pair.second);
    ASSERT_EQ(second.size(), 1U);
    EXPECT_TRUE(second[0].material_blocks.empty());
    EXPECT_FALSE(second[0].relief_tiles.empty());
    EXPECT_LT(second[0].relief_tiles.size(), editor.scene().objects[0].paint->relief->tileCount());
  }
}

// F8's scene: relief widens what the surface reaches, so that the band still holds it.
TEST_F(FeltPaints, HighReliefWidensTheBand) {
  Scene scene = ballScene();
  const auto flat = compile(scene, progress);
  Editor editor(scene, progress);
  editor.apply(dabAt(Tool::relief, 8e-3, 0.01, Vec3(0, 0, kBall)), progress);
  const auto compiled = compile(editor.scene(), progress);
  EXPECT_GE(reachOf(editor.scene()), 7.99e-3);
  EXPECT_GE(compiled->band * compiled->built.field->grid.voxel, 8e-3);
  EXPECT_GT(compiled->band, flat->band);
}

} // namespace
} // namespace patina
