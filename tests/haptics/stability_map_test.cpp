// K*(x)/K against closed forms, and against a mass on the surface.
#include "haptics/stability/stability_map.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"
#include "haptics/contact_fixture.h"
#include "haptics/law/coupling_stage.h"
#include "haptics/law/stabilisers.h"
#include "haptics/loop_model/zoh_integrator.h"

namespace patina {
namespace {

const Vec3 kSlanted = Vec3(0.3, 0.5, 0.8).normalized();

double ratioAt(const Scene& scene, const Field& field, const Vec3& point) {
  const auto at = StiffnessProbe(scene, field).at(point);
  EXPECT_TRUE(at.has_value());
  return at ? stabilityRatio(*at, scene, loopLimits(scene)) : 0;
}

// A scene without stabilisers.
Scene bare(double stiffness) {
  Scene scene = sceneOf(stiffness);
  scene.stabilisers = Stabilisers{};
  return scene;
}

double limitWith(double virtual_damping) {
  SampledLoop loop = sampledLoop(DeviceModel{});
  loop.virtual_damping = virtual_damping;
  return stiffnessLimit(loop);
}

Field bowl(double radius) {
  return cubeField([=](const Vec3& p) { return radius - p.norm(); }, 0.5e-3, 100);
}
// Two planes that meet at right angles in a groove along y, open upwards; solid below.
Field groove() {
  return cubeField([](const Vec3& p) { return (p.z() - std::abs(p.x())) / std::sqrt(2); }, 0.5e-3,
                   80);
}

TEST(StabilityRatio, IsTheDevicesLimitOverKOnAPlane) {
  for (const double stiffness : {250.0, 500.0, 2000.0})
    EXPECT_NEAR(ratioAt(bare(stiffness), planeField(), Vec3(1e-3, 0, 0)), limitWith(0) / stiffness,
                1e-3 * limitWith(0) / stiffness);
}

TEST(StabilityRatio, FallsWithDelayLikeTheLoop) {
  Scene scene = bare(500);
  scene.device_model = DeviceModel{};
  scene.device_model->delay = 2;
  EXPECT_NEAR(ratioAt(scene, planeField(), Vec3(1e-3, 0, 0)), 200.4 / 500, 1e-3);
}

TEST(StabilityRatio, DampingHelpsAlongTheNormalOnly) {
  Scene scene = bare(500);
  scene.haptics.damping = 2;
  EXPECT_NEAR(ratioAt(scene, planeField(), Vec3(1e-3, 0, 0)), limitWith(2) / 500, 0.01);
  // In a narrow bowl the tangential K d / (R + d) has the device's own damping only.
  const double radius = 1e-3, depth = 2e-3;
  const Field narrow = cubeField([=](const Vec3& p) { return radius - p.norm(); }, 0.1e-3, 80, 30);
  const double across = limitWith(0) / (500 * depth / (radius + depth));
  ASSERT_LT(across, limitWith(2) / 500);
  EXPECT_NEAR(ratioAt(scene, narrow, radius * kSlanted), across, 0.05 * across); // ten voxels
}

TEST(StabilityRatio, FrictionInStickIsKInEveryDirection) {
  const Scene slippery = bare(1500);
  EXPECT_NEAR(ratioAt(withFriction(slippery, 0.5, 0.4), sphereField(), 0.03 * kSlanted),
              limitWith(0) / 1500, 1e-3);
  Scene damped = withFriction(slippery, 0.5, 0.4);
  damped.haptics.damping = 1;
  EXPECT_NEAR(ratioAt(damped, sphereField(), 0.03 * kSlanted), limitWith(1) / 1500, 1e-3);
}

TEST(StabilityRatio, StrongerMagnetDecides) {
  Scene scene = bare(500);
  scene.haptics.magnet = Magnet{1e-3, 1600, false};
  EXPECT_NEAR(ratioAt(scene, planeField(), Vec3(1e-3, 0, 0)), limitWith(0) / 1600, 1e-3);
  scene.haptics.magnet->strength = 100;
  EXPECT_NEAR(ratioAt(scene, planeField(), Vec3(1e-3, 0, 0)), limitWith(0) / 500, 1e-3);
}

TEST(StabilityRatio, IsUnstableWithoutAnyDamping) {
  Scene scene = bare(500);
  scene.device_model = DeviceModel{};
  scene.device_model->damping = 0;
  EXPECT_LT(ratioAt(scene, planeField(), Vec3(1e-3, 0, 0)), 0.01);
}

// Growth of a mass's rms velocity from the second second to the eighth, held at `rest` by a force
// that balances the surface's there, after a nudge: below 1 it settles, above it buzzes.
double growthFrom(const Scene& scene, const Field& field, const Vec3& rest, const Vec3& nudge) {
  const auto snapshot = compileStages(scene, field);
  const DeviceModel device = scene.device_model.value_or(DeviceModel{});
  const double period = 1 / device.rate;
  const ZohStep step = zohStep({device.mass, device.damping, 0, 0}, period);
  ContactMemory memory;
  Vec3 press = Vec3::Zero();
  // twenty ticks settle the contact
  for (int i = 0; i < 20; ++i) press = -tick(*snapshot, memory, rest, period).force;
  Vec3 x = rest, v = nudge;
  double early = 0, late = 0;
  const int second = static_cast<int>(std::lround(device.rate));
  for (int i = 0; i < 8 * second; ++i) {
    const Vec3 force = tick(*snapshot, memory, x, period).force + press;
    x += step.xv * v + step.xf * force;
    v = step.vv * v + step.vf * force;
    if (i / second == 1) early += v.squaredNorm();
    if (i / second == 7) late += v.squaredNorm();
  }
  return std::sqrt(late / early);
}

// The envelope is exp(-b_eff t / 2m) with b_eff = b (1 - factor): six seconds of it.
void expectEnvelope(double factor, double damping, double grown) {
  const double expected = std::exp(-damping * (1 - factor) / (2 * DeviceModel{}.mass) * 6);
  EXPECT_NEAR(grown, expected, 0.02 * expected) << "at " << factor << " of the limit";
}

TEST(StabilityRatio, PlaneSettlesBelowOneAndBuzzesAbove) {
  const Vec3 point(1e-3, 2e-3, 0);
  const double limit = 500 * ratioAt(bare(500), planeField(), point);
  for (const double factor : {0.9, 1.1}) {
    const Vec3 rest = point - Vec3(0, 0, 1 / (factor * limit));
    expectEnvelope(factor, 0.5,
                   growthFrom(bare(factor * limit), planeField(), rest, Vec3(0, 0, 1e-3)));
  }
}

TEST(StabilityRatio, BowlSettlesBelowOneAndBuzzesAbove) {
  const double radius = 0.02;
  const Vec3 point = radius * kSlanted;
  const double limit = 500 * ratioAt(bare(500), bowl(radius), point);
  for (const double factor : {0.9, 1.1}) {
    const Vec3 rest = point + kSlanted / (factor * limit);
    expectEnvelope(factor, 0.5,
                   growthFrom(bare(factor * limit), bowl(radius), rest, 1e-3 * kSlanted));
  }
}

TEST(StabilityRatio, TangentialLoopInStickFollowsIt) {
  const Vec3 point(1e-3, 2e-3, 0);
  const double limit = 500 * ratioAt(withFriction(bare(500), 0.8, 0.8), planeField(), point);
  for (const double factor : {0.9, 1.1}) {
    const Vec3 rest = point - Vec3(0, 0, 1 / (factor * limit));
    expectEnvelope(factor, 0.5,
                   growthFrom(withFriction(bare(factor * limit), 0.8, 0.8), planeField(), rest,
                              Vec3(1e-3, 0, 0)));
  }
}

// The two sides of a groove under an offset hold the tip together, each with its own K: no
// direction is stiffer than a plane, and the loop confirms it.
TEST(StabilityRatio, GrooveUnderAnOffsetIsAsStiffAsItsSides) {
  Scene scene = bare(500);
  scene.haptics.offset = 2e-3;
  const auto at = StiffnessProbe(scene, groove()).at(Vec3::Zero());
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->lambda_max, 500, 5);
  ASSERT_GT(at->lambda_min, -1);
  EXPECT_GT(ratioAt(scene, groove(), Vec3(8e-3, 0, 8e-3)), 1.9);
  scene.device_model = DeviceModel{};
  EXPECT_GT(ratioAt(scene, groove(), Vec3::Zero()), 1.9);
  for (const double factor : {0.9, 1.1}) {
    const double damping = at->lambda_max / (2 * scene.device_model->rate) / factor;
    scene.device_model->damping = damping;
    const double ratio = ratioAt(scene, groove(), Vec3::Zero());
    EXPECT_NEAR(ratio, 1 / factor, 0.01);
    const double grown = growthFrom(scene, groove(), at->tip, Vec3(1e-3, 0, 0));
    if (factor < 1)
      EXPECT_LT(grown, 0.6);
    else
      EXPECT_GT(grown, 1.5);
  }
}

TEST(StabilityRatio, CouplingStabilisesWhereTheWallAloneIsUnstable) {
  Scene scene = bare(1e5);
  const Vec3 point = 0.03 * kSlanted;
  EXPECT_LT(ratioAt(scene, sphereField(), point), 0.02);
  scene.stabilisers = Stabilisers{true, false};
  const StiffnessLimits limits = loopLimits(scene);
  EXPECT_TRUE(limits.coupled());
  const CouplingPlan plan = planCoupling(scene.haptics, DeviceModel{});
  EXPECT_NEAR(ratioAt(scene, sphereField(), point),
              limitWith(plan.damping) / inSeries(1e5, plan.stiffness), 0.02);
  EXPECT_GT(ratioAt(scene, sphereField(), point), 1.5);
  // The coupling is on by default once the scene has a device model.
  scene.stabilisers.reset();
  EXPECT_FALSE(loopLimits(scene).coupled());
  scene.device_model = DeviceModel{};
  EXPECT_TRUE(loopLimits(scene).coupled());
}

// K d / (R + d) along a narrow bowl, behind a coupling: damped by the square of d / (R + d).
TEST(StabilityRatio, CouplingDampsMotionAlongABowl) {
  Scene scene = sceneOf(1e5);
  scene.device_model = DeviceModel{};
  const double radius = 1e-3;
  const Field narrow = cubeField([=](const Vec3& p) { return radius - p.norm(); }, 0.1e-3, 80, 30);
  const CouplingPlan plan = planCoupling(scene.haptics, DeviceModel{});
  const double k = inSeries(1e5, plan.stiffness), depth = 1 / k, share = depth / (radius + depth);
  const double along =
      (limitWith(0) + (limitWith(plan.damping) - limitWith(0)) * share * share) / (k * share);
  const double expected = std::min(along, limitWith(plan.damping) / k);
  EXPECT_NEAR(ratioAt(scene, narrow, radius * kSlanted), expected, 0.05 * expected);
}

// A force with curl: two directions of stiffness a, coupled by c and -c.
TEST(StabilityRatio, WhirlNeedsDampingEvenIfEachDirectionIsSoft) {
  Scene scene = bare(500);
  LocalStiffness at;
  at.normal = Vec3::UnitZ();
  for (const double c : {3.0, 10.0, 100.0}) {
    at.matrix << 300, -c, 0, c, 300, 0, 0, 0, 100;
    const double ratio = stabilityRatio(at, scene, loopLimits(scene));
    EXPECT_LT(ratio, 0.95 * limitWith(0) / 300);
    const ZohStep step = zohStep({0.1, 0.5, 0, 0}, 1e-3);
    for (const double scale : {0.9 * ratio, 1.1 * ratio}) {
      Vec3 x(1e-3, 0, 0), v = Vec3::Zero();
      double early = 0, late = 0;
      for (int i = 0; i < 40000; ++i) {
        const Vec3 force = -scale * at.matrix * x;
        x += step.xv * v + step.xf * force;
        v = step.vv * v + step.vf * force;
        if (i >= 10000 && i < 20000) early += v.squaredNorm();
        if (i >= 30000) late += v.squaredNorm();
      }
      if (scale < ratio)
        EXPECT_LT(late, early) << "c = " << c;
      else
        EXPECT_GT(late, early) << "c = " << c;
    }
  }
}

TEST(StabilityRatio, StiffDirectionCountsOnlyIfTheTipStays) {
  const Scene scene = bare(500);
  LocalStiffness at;
  at.normal = Vec3::UnitZ();
  at.matrix = Vec3(1500, -0.9 * kMinHandStiffness, 500).asDiagonal();
  at.lambda_min = -0.9 * kMinHandStiffness;
  EXPECT_NEAR(stabilityRatio(at, scene, loopLimits(scene)), limitWith(0) / 1500, 1e-6);
  at.lambda_min = -1.1 * kMinHandStiffness;
  EXPECT_NEAR(stabilityRatio(at, scene, loopLimits(scene)), limitWith(0) / 500, 1e-6);
}

// A ridge pushes the tip aside; this is no buzz, even if single directions are stiff.
TEST(StabilityMap, UsesAPlaneWhereTheTipSlipsOff) {
  const double h = 0.5e-3;
  const Vec3 half = Vec3::Constant(0.0103);
  TriangleMesh mesh;
  for (double aside = -0.5; aside < 0.5; aside += 0.02)
    mesh.positions.push_back(Vec3(half.x() + aside * h, half.y() - aside * h, 1e-3));
  mesh.positions.push_back(Vec3(half.x(), 1e-3, 1e-3));
  Progress progress;
  const StabilityMap map =
      stabilityMap(bare(500), cubeField([=](const Vec3& p) { return boxDistance(p, half); }, h, 64),
                   mesh, progress);
  EXPECT_GT(map.unstable_count, 5u);
  EXPECT_LT(map.unstable_count, mesh.positions.size());
  EXPECT_NEAR(map.worst_ratio, limitWith(0) / 500, 0.02);
}

TEST(StabilityMap, IsConstantOnASphere) {
  const TriangleMesh mesh = icosphere(0.03, 12);
  Progress progress;
  const StabilityMap map = stabilityMap(bare(500), sphereField(), mesh, progress);
  ASSERT_EQ(map.ratio.size(), mesh.positions.size());
  const double expected = limitWith(0) / 500;
  for (const float ratio : map.ratio) EXPECT_NEAR(ratio, expected, 1e-3 * expected);
  EXPECT_NEAR(map.worst_ratio, expected, 1e-3 * expected);
  EXPECT_EQ(map.buzzing, 0u);
  EXPECT_NEAR(map.limits.device_only, limitWith(0), 1e-6);
  const StabilityMap stiff = stabilityMap(bare(2000), sphereField(), mesh, progress);
  EXPECT_EQ(stiff.buzzing, mesh.positions.size());
}

// Pressed to the axis of a bar the contact point may be anywhere round it: there is no stiffness to
// judge, and the map marks the vertex as unknown.
TEST(StabilityMap, IsUnknownAndCountedWhereTheForceJumps) {
  const double stiffness = 500, depth = 1 / stiffness; // at 1 N
  for (const double radius : {depth, 1.5 * depth}) {
    const Field bar =
        cubeField([=](const Vec3& p) { return std::hypot(p.x(), p.z()) - radius; }, 0.25e-3, 96);
    TriangleMesh mesh;
    for (int i = 0; i < 90; ++i)
      mesh.positions.emplace_back(radius * std::cos(0.07 * i), 1e-4 * i,
                                  radius * std::sin(0.07 * i));
    Progress progress;
    const StabilityMap map = stabilityMap(bare(stiffness), bar, mesh, progress);
    const bool axis = radius == depth;
    EXPECT_EQ(map.discontinuous_count, axis ? mesh.positions.size() : 0U);
    EXPECT_EQ(map.buzzing, 0U);
    for (const float ratio : map.ratio) EXPECT_EQ(std::isnan(ratio), axis);
    EXPECT_EQ(std::isnan(map.worst_ratio), axis);
  }
}

TEST(StabilityMap, StopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(stabilityMap(bare(500), sphereField(), icosphere(0.03, 2), progress), Cancelled);
}

TEST(StabilityMap, ReportsItsProgress) {
  std::vector<double> fractions;
  Progress progress([&](double fraction, std::string_view) { fractions.push_back(fraction); });
  stabilityMap(bare(500), sphereField(), icosphere(0.03, 30), progress);
  ASSERT_FALSE(fractions.empty());
  EXPECT_EQ(fractions.front(), 0);
  EXPECT_LE(fractions.back(), 1);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

TEST(StabilityMap, NonFiniteVertexIsUnknownAndNotTheWorst) {
  TriangleMesh mesh = icosphere(0.03, 2);
  mesh.positions[0] = Vec3(NAN, 0, 0);
  Progress progress;
  const StabilityMap map = stabilityMap(bare(500), sphereField(), mesh, progress);
  EXPECT_TRUE(std::isnan(map.ratio[0]));
  EXPECT_NE(map.worst, 0u);
  EXPECT_GT(map.worst_ratio, 0);
}

// The coupling for the texture of another object does not damp a smooth one.
TEST(StabilityRatio, DeviceAloneDampsAlongASurfaceWithoutItsOwnCoupling) {
  LocalStiffness hollow;
  hollow.normal = Vec3::UnitZ();
  hollow.material.stiffness = 500;
  hollow.matrix = Vec3(400, 100, 500).asDiagonal();
  StiffnessLimits limits;
  limits.device_only = limits.damped = 1000;
  for (const double tied : {1000.0, 3000.0}) {
    limits.coupled_normal = tied;
    limits.damped = 3000;
    EXPECT_NEAR(stabilityRatio(hollow, bare(500), limits), 1000.0 / 400, 1e-9) << tied;
  }
  hollow.lateral_stiffness = 400; // the spring provides all of it
  EXPECT_NEAR(stabilityRatio(hollow, bare(500), limits), 3000.0 / 500, 1e-9);
}

} // namespace
} // namespace patina
