// Values at a point of a compiled ball, against the ball's closed forms.
#include "session/compile/probe.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

constexpr double kRadius = 0.03;

std::shared_ptr<const CompiledScene> compiledBall() {
  Scene scene;
  scene.field.resolution = 100;
  scene.haptics.stiffness = 640;
  SceneObject ball{"ball", std::make_shared<const TriangleMesh>(icosphere(kRadius, 40)),
                   Pose::Identity()};
  ball.world_from_object.translation() = Vec3(0.2, -0.1, 0);
  scene.objects = {ball};
  Progress progress;
  return compile(scene, progress);
}

TEST(ProbeAt, GivesDistanceAndRadialGradientOfABall) {
  const auto scene = compiledBall();
  const Vec3 centre(0.2, -0.1, 0);
  const double voxel = scene->built.field->grid.voxel;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const Vec3 way = Vec3(normal(random), normal(random), normal(random)).normalized();
    const double distance = (i % 5 - 2) * voxel;
    const Vec3 p = centre + (kRadius + distance) * way;
    const Probe probe = probeAt(*scene, p);
    ASSERT_TRUE(probe.in_band);
    EXPECT_EQ(probe.position, p);
    // The facets of the mesh lie up to 1e-5 m within the ball.
    EXPECT_NEAR(probe.distance, distance, 1.2e-5);
    EXPECT_GT(probe.gradient.dot(way), 0.998); // facets are up to 3° off
    EXPECT_NEAR(probe.gradient.norm(), 1, 2e-3);
    EXPECT_LT((probe.closest.point - (centre + kRadius * way)).norm(), 0.02 * kRadius);
    EXPECT_EQ(probe.object, 0U);
    EXPECT_EQ(probe.values.material.stiffness, 640);
  }
}

// Two boxes of one mesh share a wall, which is inside the body that they form.
TEST(HapticTriangles, LeaveOutAWallBetweenTwoBodies) {
  const TriangleMesh one = box(Vec3::Constant(0.02));
  TriangleMesh other = one;
  for (Vec3& p : other.positions) p.x() += 0.02;
  Scene scene;
  scene.field.resolution = 60;
  scene.objects = {
      {"pair", std::make_shared<const TriangleMesh>(joined(one, other)), Pose::Identity()}};
  Progress progress;
  const auto compiled = compile(scene, progress);
  const UnionSurface felt = hapticTriangles(*compiled, progress);
  EXPECT_EQ(felt.mesh.triangles.size(), 20U);
  EXPECT_EQ(felt.face.size(), 20U);
  const TriangleTree tree(felt.mesh);
  EXPECT_NEAR(tree.closestPoint(Vec3(0.01, 0, 0)).distance, 0.01, 1e-12);
}

TEST(ProbeAt, IsExactBeyondTheBandIfTheNearestPointIsKnown) {
  const auto scene = compiledBall();
  const TriangleTree tree(*scene->mesh);
  const Vec3 centre(0.2, -0.1, 0), far = centre + Vec3(0, 0, 0.1);
  EXPECT_FALSE(probeAt(*scene, far).in_band);
  EXPECT_FALSE(probeAt(*scene, far).object);
  const Probe probe = probeAt(*scene, far, tree.closestPoint(far));
  EXPECT_NEAR(probe.distance, 0.1 - kRadius, 1.2e-5);
  EXPECT_GT(probe.gradient.z(), 0.9999);
  EXPECT_EQ(probe.object, 0U);
  const Probe centred =
      probeAt(*scene, centre + Vec3(1e-3, 0, 0), tree.closestPoint(centre + Vec3(1e-3, 0, 0)));
  EXPECT_NEAR(centred.distance, 1e-3 - kRadius, 1.2e-5);
}

TEST(ProbeAt, GivesTheHeightOfAScannedTexture) {
  constexpr double kPeriod = 0.002, kHeight = 3e-5;
  FourierTexture sine;
  sine.name = "sine";
  sine.omega = 2 * M_PI / kPeriod;
  sine.series.a = {0};
  sine.series.b = {kHeight};
  sine.low = -kHeight;
  TextureMappings laid;
  SceneObject plate{"plate", std::make_shared<const TriangleMesh>(sheet(0.06, 0.06, 6)),
                    Pose::Identity()};
  for (std::size_t f = 0; f < plate.mesh->triangles.size(); ++f) {
    TexturedFace face{static_cast<std::int32_t>(f), 1, {}};
    for (int k = 0; k < 3; ++k)
      face.coords[static_cast<std::size_t>(k)] = plate.mesh->corner(f, k).head<2>();
    laid.faces.push_back(face);
  }
  laid.library[1] = hapticTexture(sine);
  ObjectPaint paint;
  paint.textures = std::make_shared<const TextureMappings>(laid);
  plate.paint = std::make_shared<const ObjectPaint>(paint);
  Scene scene;
  scene.field.resolution = 60;
  scene.objects = {plate};
  Progress progress;
  const auto compiled = compile(scene, progress);
  for (const double x : {0.0, 0.0004, 0.0011, -0.0007}) {
    const Probe probe = probeAt(*compiled, Vec3(x, 0.001, 0.0005));
    ASSERT_TRUE(probe.texture) << x;
    EXPECT_NEAR(*probe.texture, kHeight * std::sin(2 * M_PI * x / kPeriod), 1e-9) << x;
  }
}

} // namespace
} // namespace patina
