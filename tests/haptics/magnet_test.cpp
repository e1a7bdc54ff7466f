#include <numbers>

#include <gtest/gtest.h>

#include "haptics/contact_fixture.h"
#include "haptics/loop_model/zoh_integrator.h"

namespace patina {
namespace {

Scene magnetic(double stiffness, double range, double strength, bool fades = false) {
  Scene scene = sceneOf(stiffness);
  scene.haptics.magnet = Magnet{range, strength, fades};
  return scene;
}

// T-K13a.
TEST(Magnet, ForceProfileIsExactOverAPlane) {
  const double K = 800, k_m = 300, w = 2e-3;
  for (const bool fades : {false, true}) {
    const auto snapshot = compileStages(magnetic(K, w, k_m, fades), planeField());
    for (double z = -1.5e-3; z < 3e-3; z += 13e-6) {
      const Contact contact = touchOnce(*snapshot, Vec3(1e-3, -2e-3, z));
      double expected = 0;
      if (z < 0) expected = -K * z;
      if (z > 0 && z < w) expected = fades && z > 0.75 * w ? -k_m * 3 * (w - z) : -k_m * z;
      EXPECT_NEAR(contact.force.z(), expected, 1e-6) << z;
      EXPECT_NEAR(contact.force.head<2>().norm(), 0, 1e-12);
      EXPECT_EQ(contact.attracted, z > 0 && z < w) << z;
      EXPECT_NEAR(contact.surface.z(), z < w ? 0 : z, 1e-9);
    }
  }
}

// T-K13b and c: the pull-off peak and its work; coming back returns the work.
TEST(Magnet, PullOffWorkMatchesTheClosedFormAndIsReturned) {
  const double R = 0.03, k_m = 400, w = 2e-3, step = 1e-6;
  const auto snapshot = compileStages(magnetic(500, w, k_m), sphereField(R));
  const Vec3 n = Vec3(1, 2, 2) / 3;
  ContactMemory memory;
  double peak = 0, out = 0, back = 0;
  const int count = static_cast<int>(std::lround(1.2 * w / step));
  double last = 0;
  for (int i = 0; i <= count; ++i) {
    const double pull = -tick(*snapshot, memory, (R + i * step) * n, 1e-3).force.dot(n);
    peak = std::max(peak, pull);
    out += 0.5 * (pull + last) * step;
    last = pull;
  }
  for (int i = count; i >= 0; --i) {
    const double pull = -tick(*snapshot, memory, (R + i * step) * n, 1e-3).force.dot(n);
    back += 0.5 * (pull + last) * step;
    last = pull;
  }
  EXPECT_NEAR(peak / (k_m * w), 1, 2e-3);
  EXPECT_NEAR(out / (0.5 * k_m * w * w), 1, 2e-3);
  EXPECT_NEAR(back, out, 1e-3 * out);
  EXPECT_FALSE(memory.limit.fault); // the step at the band's edge belongs to the model
}

// T-K13c: quasi-static loops of radius 0.7 mm inside the band.
TEST(Magnet, ClosedLoopsDoNoWork) {
  const double R = 0.03, k_m = 400, w = 2.5e-3;
  const auto snapshot = compileStages(magnetic(500, w, k_m), sphereField(R, 120));
  std::mt19937 random(3);
  for (int loop = 0; loop < 20; ++loop) {
    const Vec3 n = randomDirection(random);
    const Vec3 u = n.unitOrthogonal();
    const Vec3 middle = (R + 0.5 * w) * n;
    const int count = 4000;
    ContactMemory memory;
    double work = 0;
    Vec3 last_force = Vec3::Zero(), last_tip = Vec3::Zero();
    for (int i = 0; i <= count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count;
      const Vec3 tip = middle + 0.7e-3 * (std::cos(angle) * u + std::sin(angle) * n);
      const Vec3 force = tick(*snapshot, memory, tip, 1e-3).force;
      if (i) work += 0.5 * (force + last_force).dot(tip - last_tip);
      last_force = force;
      last_tip = tip;
    }
    EXPECT_LT(std::abs(work), 0.01 * 0.5 * k_m * w * w);
    EXPECT_LT(std::abs(work), 3e-6);
  }
}

// T-K13d / F14: a device released in the band swings between two springs; its amplitude ratio a
// cycle is exp(-(pi/2) sum_i (b - K_i T/2) / sqrt(K_i m)).
double amplitudeRatio(double K, double k_m, double m, double b, double T) {
  const double w = 4e-3;
  const auto snapshot = compileStages(magnetic(K, w, k_m), planeField(0x1p-10));
  const ZohStep step = zohStep({m, b, 0, 0}, T);
  double x = 0.5 * w, v = 0;
  ContactMemory memory;
  std::vector<double> peaks;
  double last_v = 0, last_x = x;
  for (int i = 0; i < 200000 && peaks.size() < 40; ++i) {
    const double force = tick(*snapshot, memory, Vec3(0, 0, x), T).force.z();
    last_v = v;
    last_x = x;
    x = last_x + step.xv * last_v + step.xf * force;
    v = step.vv * last_v + step.vf * force;
    if (last_v > 0 && v <= 0) {
      // The top lies between two samples: exact for a constant acceleration.
      const double acceleration = (v - last_v) / T;
      peaks.push_back(last_x - 0.5 * last_v * last_v / acceleration);
    }
  }
  const std::size_t cycles = peaks.size() - 1;
  return std::pow(peaks.back() / peaks.front(), 1.0 / static_cast<double>(cycles));
}

TEST(Magnet, FreeDeviceSwingsLikeOnTwoSprings) {
  const double m = 0.1, b = 0.5, T = 0.5e-3;
  for (const auto& [k_m, K] : {std::pair(500.0, 1500.0), std::pair(3000.0, 1500.0)}) {
    double sum = 0;
    for (const double k : {K, k_m}) sum += (b - 0.5 * k * T) / std::sqrt(k * m);
    const double predicted = std::exp(-0.5 * std::numbers::pi * sum);
    EXPECT_NEAR(amplitudeRatio(K, k_m, m, b, T) / predicted, 1, 2e-3) << k_m << ' ' << K;
  }
}

// K08: without a magnet the surface never pulls on retreat; a magnet may.
TEST(Magnet, DampingPullsOnRetreat) {
  for (const bool magnet : {false, true}) {
    Scene scene = magnet ? magnetic(300, 2e-3, 300) : sceneOf(300);
    scene.haptics.damping = 5;
    const auto snapshot = compileStages(scene, planeField());
    ContactMemory memory;
    double least = 0;
    for (int i = 0; i < 10; ++i)
      least =
          std::min(least, tick(*snapshot, memory, Vec3(0, 0, -2e-3 + 2e-4 * i), 1e-3).force.z());
    EXPECT_EQ(least < -0.5, magnet);
  }
}

// MATH 2.8: a groove, where two points are equally near.
TEST(Magnet, ForceIsContinuousInAGroove) {
  const double k_m = 400, w = 2e-3, half = 1e-3, voxel = 0.1e-3;
  const Field groove =
      cubeField([=](const Vec3& p) { return half - std::abs(p.x()); }, voxel, 80, 30);
  const auto snapshot = compileStages(magnetic(500, w, k_m), groove);
  Vec3 last = touchOnce(*snapshot, Vec3(-0.95e-3, 0, 0)).force;
  const double step = 2e-6;
  for (double x = -0.95e-3 + step; x < 0.95e-3; x += step) {
    const Vec3 force = touchOnce(*snapshot, Vec3(x, 0, 0)).force;
    ASSERT_TRUE(force.allFinite());
    // The pull reverses from wall to wall within two cells.
    ASSERT_LT((force - last).norm(), 3 * k_m * half * step / voxel) << x;
    last = force;
  }
}

TEST(Magnet, IsLeftOutWithoutRangeOrStrength) {
  const Field sphere = sphereField(0.03, 60);
  EXPECT_EQ(compileStages(magnetic(500, 0, 300), sphere)->stages.size(), 3u);
  EXPECT_EQ(compileStages(magnetic(500, 2e-3, 0), sphere)->stages.size(), 3u);
  EXPECT_EQ(compileStages(magnetic(500, 2e-3, 300), sphere)->stages.size(), 4u);
}

} // namespace
} // namespace patina
