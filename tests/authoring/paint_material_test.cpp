// The brush over the material map (K22).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "authoring/brush/surface_values.h"
#include "authoring/paint_fixture.h"

namespace patina {
namespace {

using test::brushOf;
using test::objectOf;
using test::sceneOf;
using test::strokeAlong;
using test::strokeAt;
using test::surfaceOf;
using test::valuesAt;

constexpr double kPlateTop = 0.01;

Scene plate() {
  return sceneOf(box(Vec3(0.1, 0.1, 2 * kPlateTop), 6), 75);
}

// T-K22b: the result is the same at any position in its cell.
TEST(PaintMaterial, HardBrushOfTwoVoxelsGivesExactlyTheRequestedStiffness) {
  const Scene scene = plate();
  const auto surface = surfaceOf(scene, false);
  Brush brush =
      brushOf(Tool::material(MaterialChannel::stiffness), 2 * surface->field->grid.voxel, 1000);
  brush.falloff = 1000;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-0.04, 0.04);
  for (int k = 0; k < 50; ++k) {
    const Vec3 p(place(random), place(random), kPlateTop);
    const Scene after = painted(surface, scene, strokeAt(brush, p));
    EXPECT_NEAR(valuesAt(*surface, after, p).material.stiffness, 1000, 1e-9);
  }
}

// T-K22b: a brush without a hard core gives .67 of the value over zero, on average over the cell.
TEST(PaintMaterial, SoftBrushOfTwoVoxelsGivesTwoThirds) {
  const Scene scene = sceneOf(icosphere(0.05, 12), 75);
  const auto surface = surfaceOf(scene, false);
  const Brush brush =
      brushOf(Tool::material(MaterialChannel::damping), 2 * surface->field->grid.voxel, 10);
  VolumeFill fill(surface);
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  double sum = 0;
  constexpr int kPlaces = 600;
  for (int k = 0; k < kPlaces; ++k) {
    const Vec3 p = 0.05 * Vec3(normal(random), normal(random), normal(random)).normalized();
    const Scene after = painted(surface, scene, strokeAt(brush, p));
    sum += surfaceValues(after, 0, fill.foot(p)->surface).material.damping / 10;
  }
  std::printf("f = 1 at r = 2 h: %.3f of the value\n", sum / kPlaces);
  EXPECT_NEAR(sum / kPlaces, 0.67, 0.01);
}

TEST(PaintMaterial, NodesLieWhereTheFieldsDo) {
  for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(0.25, -0.5, 0.125)}) {
    const Pose pose(Eigen::Translation3d{shift});
    const Scene scene = sceneOf({objectOf("plate", box(Vec3(0.1, 0.1, 0.02), 6), pose)});
    const auto surface = surfaceOf(scene, false);
    const Scene after =
        painted(surface, scene,
                strokeAt(brushOf(Tool::material(MaterialChannel::roughness), 0.01, 1e-5),
                         shift + Vec3(0, 0, kPlateTop)));
    const MaterialMap& map = *after.objects[0].paint->material;
    EXPECT_EQ(map.voxel(), surface->field->grid.voxel);
    EXPECT_EQ(map.origin() + shift, surface->field->grid.origin);
  }
}

TEST(PaintMaterial, StaysWithAnObjectThatMoves) {
  Scene scene = plate();
  const Scene after =
      painted(surfaceOf(scene, false), scene,
              strokeAt(brushOf(Tool::material(MaterialChannel::stiffness), 0.01, 900),
                       Vec3(0, 0, kPlateTop)));
  Scene moved = after;
  moved.objects[0].world_from_object =
      Pose(Eigen::Translation3d(0.1, 0, 0) * Eigen::AngleAxisd(1.1, Vec3(1, 1, 0).normalized()));
  const auto surface = surfaceOf(moved, false);
  const Pose& pose = moved.objects[0].world_from_object;
  const double there =
      valuesAt(*surface, moved, pose * Vec3(0.002, 0, kPlateTop)).material.stiffness;
  EXPECT_GT(there, 700);
  // More paint is added on the grid of the first stroke.
  const Scene more =
      painted(surface, moved,
              strokeAt(brushOf(Tool::material(MaterialChannel::stiffness), 0.02, 900),
                       pose * Vec3(0.03, 0, kPlateTop)));
  EXPECT_EQ(more.objects[0].paint->material->origin(), after.objects[0].paint->material->origin());
  EXPECT_GT(valuesAt(*surface, more, pose * Vec3(0.03, 0.001, kPlateTop)).material.stiffness, 780);
  EXPECT_GE(valuesAt(*surface, more, pose * Vec3(0.002, 0, kPlateTop)).material.stiffness, there);
}

// K22: a lattice's covering radius is .866 h; a smaller brush can fall between the nodes.
TEST(PaintMaterial, BrushBetweenTheNodesIsReported) {
  const Scene scene = plate();
  const auto surface = surfaceOf(scene, false);
  const FieldGrid& grid = surface->field->grid;
  Vec3 q = grid.toGrid(Vec3(0, 0, kPlateTop));
  q[0] = std::floor(q[0]) + 0.5;
  q[1] = std::floor(q[1]) + 0.5;
  PaintReport report;
  const Scene after =
      painted(surface, scene,
              strokeAt(brushOf(Tool::material(MaterialChannel::stiffness), 0.4 * grid.voxel, 900),
                       grid.toWorld(q)),
              &report);
  EXPECT_EQ(report.nodes, 0u);
  EXPECT_EQ(report.missed, 0u);
  EXPECT_GT(report.faces, 0u);
  EXPECT_EQ(after.objects[0].paint, nullptr);
}

TEST(PaintMaterial, AddedStiffnessStaysWithinItsRange) {
  const Scene scene = plate();
  const auto surface = surfaceOf(scene, false);
  Brush brush = brushOf(Tool::material(MaterialChannel::static_friction), 0.02, 0.3);
  brush.mode = StrokeMode::add;
  brush.falloff = 1000;
  Scene now = scene;
  const Vec3 p(0.001, 0.002, kPlateTop);
  for (int k = 1; k <= 3; ++k) {
    now = painted(surface, now, strokeAlong(brush, p, p + Vec3(0.01, 0, 0), 20));
    EXPECT_NEAR(valuesAt(*surface, now, p).material.static_friction, 0.3 * k, 1e-6);
  }
  brush.value = -2;
  now = painted(surface, now, strokeAt(brush, p));
  EXPECT_NEAR(valuesAt(*surface, now, p).material.static_friction, 0, 1e-6);
  EXPECT_GE(valuesAt(*surface, now, p).material.static_friction, 0);
}

TEST(PaintMaterial, AddsToTheUnpaintedValue) {
  const Scene scene = plate(); // 500 N/m
  const auto surface = surfaceOf(scene, false);
  Brush brush = brushOf(Tool::material(MaterialChannel::stiffness), 0.02, -300);
  brush.mode = StrokeMode::add;
  brush.falloff = 1000;
  const Vec3 p(0.001, 0.002, kPlateTop);
  Scene now = painted(surface, scene, strokeAt(brush, p));
  EXPECT_NEAR(valuesAt(*surface, now, p).material.stiffness, 200, 1e-4);
  now = painted(surface, now, strokeAt(brush, p));
  const double least = rangeOf(MaterialChannel::stiffness).min;
  EXPECT_NEAR(valuesAt(*surface, now, p).material.stiffness, least, 1e-4);
}

TEST(PaintMaterial, SmoothingLowersTheSteepestSlope) {
  const Scene scene = plate();
  const auto surface = surfaceOf(scene, false);
  Brush brush = brushOf(Tool::material(MaterialChannel::stiffness), 0.02, 2000);
  brush.falloff = 1000;
  const Scene cliff = painted(surface, scene, strokeAt(brush, Vec3(0, 0, kPlateTop)));
  brush.mode = StrokeMode::smooth;
  brush.radius = 0.03;
  Stroke stroke{brush, {}};
  for (int k = 0; k < 10; ++k) stroke.samples.push_back({k / 60.0, Vec3(0, 0, kPlateTop), 0});
  const Scene smoother = painted(surface, cliff, stroke);
  const auto steepest = [&](const Scene& s) {
    double worst = 0;
    for (double x = 0; x < 0.028; x += 5e-4)
      worst = std::max(
          worst, std::abs(valuesAt(*surface, s, Vec3(x, 0, kPlateTop)).material.stiffness -
                          valuesAt(*surface, s, Vec3(x + 1e-3, 0, kPlateTop)).material.stiffness));
    return worst;
  };
  EXPECT_LT(steepest(smoother), 0.5 * steepest(cliff));
  EXPECT_NEAR(valuesAt(*surface, smoother, Vec3(0, 0, kPlateTop)).material.stiffness, 2000, 1);
}

// The far side of a wall of several voxels keeps its values.
TEST(PaintMaterial, FrontOnlyLeavesTheNodesOfTheFarSide) {
  const Scene scene = sceneOf(box(Vec3(0.1, 0.1, 0.008), 6), 100);
  const auto surface = surfaceOf(scene, false);
  ASSERT_GT(0.008, 5 * surface->field->grid.voxel);
  Brush brush = brushOf(Tool::material(MaterialChannel::stiffness), 0.02, 1000);
  brush.falloff = 1000;
  const Vec3 p(0, 0, 0.004);
  const Scene both = painted(surface, scene, strokeAt(brush, p));
  EXPECT_NEAR(valuesAt(*surface, both, -p).material.stiffness, 1000, 1e-6);
  brush.front_only = true;
  const Scene front = painted(surface, scene, strokeAt(brush, p));
  EXPECT_NEAR(valuesAt(*surface, front, p).material.stiffness, 1000, 1e-6);
  EXPECT_EQ(valuesAt(*surface, front, -p).material.stiffness, 500);
}

} // namespace
} // namespace patina
