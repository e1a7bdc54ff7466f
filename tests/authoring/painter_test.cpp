#include <gtest/gtest.h>

#include "authoring/surface_values.h"
#include "authoring/volume_fill.h"
#include "authoring/paint_fixture.h"

namespace patina {
namespace {

using test::brushOf;
using test::sceneOf;
using test::strokeAlong;
using test::strokeAt;
using test::surfaceOf;

SurfaceValues valuesAt(const std::shared_ptr<const PaintSurface>& surface, const Scene& scene,
                       const Vec3& p) {
  VolumeFill fill(surface);
  const auto foot = fill.foot(p);
  EXPECT_TRUE(foot);
  return surfaceValues(scene, 0, foot->surface);
}

TEST(Painter, ColorIsThereAfterADabAndNowhereElse) {
  const Scene scene = sceneOf(icosphere(0.05, 12), 60, 256);
  const auto surface = surfaceOf(scene);
  Brush brush = brushOf(Tool::color, 0.02);
  brush.falloff = 50;
  brush.color = {0.2, 0.4, 0.8};
  PaintReport report;
  const Scene after = painted(surface, scene, strokeAt(brush, Vec3(0, 0, 0.05)), &report);
  EXPECT_EQ(report.dabs, 1u);
  EXPECT_GT(report.texels, 100u);
  const SurfaceValues at = valuesAt(surface, after, Vec3(0, 0, 0.05));
  EXPECT_NEAR(at.color[0], 0.2, 1e-3);
  EXPECT_NEAR(at.color[2], 0.8, 1e-3);
  EXPECT_NEAR(at.color[3], 1, 1e-3);
  EXPECT_EQ(valuesAt(surface, after, Vec3(0, 0, -0.05)).color[3], 0);
  EXPECT_EQ(valuesAt(surface, after, Vec3(0.05, 0, 0)).color[3], 0);
}

// T-K22b.
TEST(Painter, HardBrushGivesTheStiffnessItWasTold) {
  const Scene scene = sceneOf(icosphere(0.05, 12));
  const auto surface = surfaceOf(scene, false);
  Brush brush = brushOf(Tool::stiffness, 2 * surface->field->grid.voxel, 1000);
  brush.falloff = 1000;
  const Scene after = painted(surface, scene, strokeAt(brush, Vec3(0, 0, 0.05)));
  EXPECT_NEAR(valuesAt(surface, after, Vec3(0, 0, 0.05)).material.stiffness, 1000, 1e-9);
  EXPECT_EQ(valuesAt(surface, after, Vec3(0, 0, -0.05)).material.stiffness, 500);
}

TEST(Painter, UndoIsTheOldValueBitForBit) {
  const Scene scene = sceneOf(icosphere(0.05, 12));
  const auto surface = surfaceOf(scene);
  const Scene one = painted(surface, scene, strokeAt(brushOf(Tool::color, 0.02), Vec3(0, 0, 0.05)));
  const ObjectPaint before = *one.objects[0].paint;
  const TiledImage copy = *before.color;
  const Scene two = painted(
      surface, one, strokeAlong(brushOf(Tool::color, 0.02), Vec3(0, 0, 0.05), Vec3(0.05, 0, 0), 9));
  EXPECT_TRUE(same(*one.objects[0].paint->color, copy));
  EXPECT_FALSE(same(*two.objects[0].paint, before));
}

} // namespace
} // namespace patina
