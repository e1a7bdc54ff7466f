#include "authoring/brush/paint_surface.h"

#include <gtest/gtest.h>

#include "authoring/paint_fixture.h"
#include "core/error.h"

namespace patina {
namespace {

using test::brushOf;
using test::objectOf;
using test::sceneOf;
using test::strokeAt;
using test::surfaceOf;

TEST(PaintSurface, HoldsNoImagesUntilRequested) {
  const Scene scene = sceneOf(icosphere(0.05, 8));
  const auto bare = surfaceOf(scene, false);
  EXPECT_FALSE(hasImages(*bare));
  EXPECT_EQ(bare->objects[0].texels, nullptr);
  const auto full = surfaceOf(scene);
  EXPECT_TRUE(hasImages(*full));
  EXPECT_GE(full->bytes(), bare->bytes() + 128 * 128 * sizeof(std::int32_t));
}

TEST(PaintSurface, ImagesKeepTheSizeAndLayoutTheyWerePaintedIn) {
  Scene scene =
      sceneOf({objectOf("a", icosphere(0.02, 8)),
               objectOf("b", icosphere(0.02, 8), Pose(Eigen::Translation3d(0.05, 0, 0)))});
  const auto first = surfaceOf(scene);
  Scene after = painted(first, scene, strokeAt(brushOf(Tool::color, 0.01), Vec3(0, 0, 0.02)));
  after.paint_size = 256;
  const auto second = surfaceOf(after);
  EXPECT_EQ(second->objects[0].texels->width, 128);
  EXPECT_EQ(second->objects[0].layout.uvs, after.objects[0].paint->layout.uvs);
  EXPECT_EQ(second->objects[1].texels->width, 256);
  const Scene more =
      painted(second, after, strokeAt(brushOf(Tool::relief, 0.01, 1e-3), Vec3(0, 0, 0.02)));
  EXPECT_EQ(more.objects[0].paint->relief->width(), 128);
  EXPECT_EQ(more.objects[0].paint->color, after.objects[0].paint->color);
  EXPECT_EQ(more.objects[1].paint, nullptr);
  // Existing images are kept.
  Progress progress;
  const auto third = withImages(*second, more, progress);
  EXPECT_EQ(third->objects[0].texels, second->objects[0].texels);
  EXPECT_EQ(third->objects[1].texels, second->objects[1].texels);
}

TEST(PaintSurface, CanBeCancelledAndRejectsTheMeshOfAnotherScene) {
  const Scene scene = sceneOf(icosphere(0.05, 8));
  const auto surface = surfaceOf(scene, false);
  Progress cancelled;
  cancelled.cancel();
  EXPECT_THROW(paintSurface(scene, surface->mesh, surface->field, cancelled), Cancelled);
  EXPECT_THROW(withImages(*surface, scene, cancelled), Cancelled);
  Progress progress;
  const Scene other = sceneOf(icosphere(0.05, 9));
  EXPECT_THROW(paintSurface(other, surface->mesh, surface->field, progress), std::invalid_argument);
}

TEST(SurfaceValues, EqualTheSceneValuesWithoutPaint) {
  Scene scene = sceneOf(icosphere(0.05, 8));
  scene.haptics.stiffness = 432;
  scene.haptics.friction = Friction{0.5, 0.25};
  const SurfacePoint point{3, Vec3::Constant(1.0 / 3)};
  const SurfaceValues bare = surfaceValues(scene, 0, point);
  EXPECT_EQ(bare.material, baseMaterial(scene.haptics));
  EXPECT_EQ(bare.color[3], 0);
  EXPECT_EQ(bare.height, 0);
  const auto surface = surfaceOf(scene);
  const Vec3 p = position(*surface->mesh, point);
  const Scene after = painted(
      surface, scene, strokeAt(brushOf(Tool::material(MaterialChannel::stiffness), 0.02, 800), p));
  const SurfaceValues there = surfaceValues(after, 0, point);
  EXPECT_GT(there.material.stiffness, 700);
  EXPECT_EQ(there.material.dynamic_friction, 0.25);
  EXPECT_THROW((void)surfaceValues(after, 7, point), std::out_of_range);
}

} // namespace
} // namespace patina
