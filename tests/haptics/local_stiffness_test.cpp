// The closed forms of MATH 2.1.7, on analytic fields.
#include "haptics/stability/stability_map.h"

#include <gtest/gtest.h>

#include "haptics/painted_fixture.h"

namespace patina {
namespace {

constexpr double kPlain = 500;              // [N/m]
constexpr double kRounding = 3e-5 * kPlain; // see the step in stability_map.h

const Vec3 kOblique = Vec3(0.3, 0.5, 0.8).normalized();

LocalStiffness stiffnessUnder(const Scene& scene, const Field& field, const Vec3& point,
                              std::optional<double> depth = {}) {
  const auto result = StiffnessProbe(scene, field).at(point, depth);
  EXPECT_TRUE(result.has_value());
  return result.value_or(LocalStiffness{});
}

// phi of a cavity in a solid.
Field bowlField(double radius, double voxel, int cells) {
  return cubeField([=](const Vec3& p) { return radius - p.norm(); }, voxel, cells);
}

TEST(LocalStiffness, IsKAlongAPlanesNormalAndZeroAcross) {
  const LocalStiffness at = stiffnessUnder(sceneOf(kPlain), planeField(), Vec3(1e-3, 2e-3, 1e-4));
  EXPECT_NEAR(at.depth, 1 / kPlain, 1e-12); // 1 N
  EXPECT_NEAR(at.force, 1, 1e-6);
  EXPECT_NEAR(at.lambda_max, kPlain, kRounding);
  EXPECT_NEAR(at.lambda_min, 0, kRounding);
  EXPECT_LT(at.uncertainty, kRounding);
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  expected(2, 2) = kPlain;
  EXPECT_LT((at.matrix - expected).cwiseAbs().maxCoeff(), kRounding);
}

TEST(LocalStiffness, StepStaysInContactNearTheSurface) {
  const double stiff = 1e6;
  const LocalStiffness at = stiffnessUnder(sceneOf(stiff), planeField(), Vec3(1e-3, 2e-3, 0));
  EXPECT_NEAR(at.lambda_max, stiff, 1e-3 * stiff); // 1 um deep: a float's accuracy
}

TEST(LocalStiffness, ConvexBodiesPushTheTipAside) {
  const double radius = 0.03;
  for (const double depth : {0.5e-3, 2e-3, 4e-3}) {
    const LocalStiffness at =
        stiffnessUnder(sceneOf(kPlain), sphereField(radius), radius * kOblique, depth);
    EXPECT_NEAR(at.lambda_max, kPlain, 1e-4 * kPlain);
    const double expected = -kPlain * depth / (radius - depth);
    // Nodal gradients are of order h^2: 0.25 % of it.
    EXPECT_NEAR(at.lambda_min, expected, 0.01 * std::abs(expected));
    EXPECT_NEAR(at.matrix.trace(), kPlain + 2 * expected, 0.02 * std::abs(expected));
  }
}

TEST(LocalStiffness, ConcaveBodiesHoldTheTip) {
  const double radius = 0.02, depth = 2e-3;
  const LocalStiffness at =
      stiffnessUnder(sceneOf(kPlain), bowlField(radius, 0.5e-3, 100), radius * kOblique, depth);
  const double expected = kPlain * depth / (radius + depth);
  EXPECT_NEAR(at.lambda_max, kPlain, 1e-4 * kPlain);
  EXPECT_NEAR(at.lambda_min, expected, 0.02 * expected);
}

TEST(LocalStiffness, UsesTheDepthUnderAnOffsetSurface) {
  const double radius = 0.03, offset = 2e-3, depth = 1e-3;
  Scene scene = sceneOf(kPlain);
  scene.haptics.offset = offset;
  const LocalStiffness at = stiffnessUnder(scene, sphereField(radius), radius * kOblique, depth);
  EXPECT_NEAR((at.tip - (radius + offset - depth) * kOblique).norm(), 0, 1e-6);
  EXPECT_NEAR(at.force, kPlain * depth, 1e-3);
  EXPECT_NEAR(at.lambda_max, kPlain, 1e-4 * kPlain);
  const double expected = -kPlain * depth / (radius + offset - depth);
  EXPECT_NEAR(at.lambda_min, expected, 0.02 * std::abs(expected));
}

// A ridge holds no tip: pressed in along the bisector it ends on one of the faces, and the result
// marks this.
TEST(LocalStiffness, ReportsThatTheTipSlipsOffARidge) {
  const double h = 0.5e-3;
  const Vec3 half = Vec3::Constant(0.0103);
  const Field field = cubeField([=](const Vec3& p) { return boxDistance(p, half); }, h, 64);
  const StiffnessProbe probe(sceneOf(kPlain), field);
  for (const double depth : {2.0, 4.0}) {
    const auto at = probe.at(Vec3(half.x(), half.y() - 0.1 * h, 1e-3), depth * h);
    ASSERT_TRUE(at);
    EXPECT_TRUE(at->is_unstable);
    EXPECT_NEAR(at->lambda_max, kPlain, 0.01 * kPlain);
    EXPECT_GT(at->normal.head<2>().maxCoeff(), 0.99);
  }
  const auto beside = probe.at(Vec3(half.x(), 1e-3, 1e-3), 2 * h);
  ASSERT_TRUE(beside);
  EXPECT_FALSE(beside->is_unstable);
}

TEST(LocalStiffness, HoldsTheTipPastTheMiddleOfAThinPlateLikeTheServo) {
  Scene scene = sceneOf(kPlain);
  const LocalStiffness held = stiffnessUnder(scene, plateField(), Vec3(1e-4, 2e-4, 0.25e-3));
  EXPECT_NEAR(held.lambda_max, kPlain, 1e-3 * kPlain);
  EXPECT_NEAR(held.force, 1, 1e-3); // 2 mm deep in 0.5 mm: on the side of entry
  EXPECT_GT(held.normal.z(), 0.999);
  scene.haptics.contact = HapticProperties::Contact::ray;
  EXPECT_FALSE(StiffnessProbe(scene, plateField()).at(Vec3(1e-4, 2e-4, 0.25e-3)));
}

TEST(LocalStiffness, IsAbsentWithoutADirection) {
  const StiffnessProbe probe(sceneOf(kPlain), sphereField());
  EXPECT_FALSE(probe.at(Vec3(0.1, 0.1, 0.1)));
  EXPECT_FALSE(probe.at(Vec3(0.03, NAN, 0)));
}

TEST(LocalStiffness, DoesNotDependOnTimeAndPath) {
  Scene scene = withFriction(sceneOf(kPlain), 0.5, 0.4);
  scene.haptics.damping = 2;
  scene.haptics.force_limit = 0.5;
  const Vec3 point = 0.03 * kOblique;
  const LocalStiffness at = stiffnessUnder(scene, sphereField(), point, 2e-3);
  EXPECT_EQ(at.matrix, stiffnessUnder(sceneOf(kPlain), sphereField(), point, 2e-3).matrix);
  EXPECT_NEAR(at.force, 1, 1e-4);
  EXPECT_NEAR(stiffnessUnder(scene, sphereField(), point).force, 0.5, 1e-4);
}

// Painted stiffness of any value is pressed by 1 N and felt beneath the relief.
TEST(LocalStiffness, PressesPaintedStiffnessByTheSameForce) {
  const double voxel = 0x1p-11;
  for (const double painted : {250.0, 2000.0}) {
    const Scene scene = sceneOf(kPlain);
    const HapticObject object =
        hapticMaterial(*coveredMap(voxel, cube(4e-3), MaterialChannel::stiffness,
                                   [=](const Vec3&) { return painted; }),
                       scene);
    const auto at =
        StiffnessProbe(scene, planeField(voxel, 32), std::span(&object, 1)).at(Vec3(1e-3, 5e-4, 0));
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->depth, 1 / painted, 1e-9);
    EXPECT_NEAR(at->force, 1, 1e-4);
    EXPECT_NEAR(at->lambda_max, painted, 1e-3 * painted);
  }
}

TEST(LocalStiffness, MeasuresTheDepthBeneathARampOfRelief) {
  const double slope = 0.5, x = 1.3e-3, depth = 0.5e-3;
  const HapticObject ramp =
      hapticRelief(fineSlab().faces, reliefImage(64, [](double u, double) { return u - 0.5; }),
                   slope * Slab::kSide, 0.1);
  Scene scene = sceneOf(kPlain);
  scene.relief.form = ForceForm::conservative;
  const auto at =
      StiffnessProbe(scene, fineSlab().field, std::span(&ramp, 1)).at(Vec3(x, 7e-4, 0), depth);
  ASSERT_TRUE(at);
  EXPECT_LT((at->tip - Vec3(x, 7e-4, slope * x - depth)).norm(), 1e-6);
  // 1/2 K d^2, d the depth along z.
  EXPECT_NEAR(at->force, kPlain * depth * std::sqrt(1 + slope * slope), 1e-3);
}

} // namespace
} // namespace patina
