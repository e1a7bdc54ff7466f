// E_k = -sum F_{k-1} . (x_k - x_{k-1}), MATH 2.3.
#include <cmath>

#include <gtest/gtest.h>

#include "app/gui/servo/live_plots.h"

namespace patina {
namespace {

// A wall at x = 0 with spring K, damper B, sampled; the tip goes x = -a sin(w k T).
ToolSample wallSample(double x, double velocity, double stiffness, double damping) {
  ToolSample sample;
  sample.tip = Vec3(x, 0, 0);
  sample.contact = x < 0;
  if (x < 0) sample.force = Vec3(-stiffness * x - damping * velocity, 0, 0);
  return sample;
}

TEST(EnergyMeter, SampledSpringTakesTheTriangleLessHalfAStep) {
  // Steps of s down to depth n s: sum of K j s^2 for j < n = K s^2 n (n - 1) / 2 exactly; on the
  // way back the sum is over j <= n: the given energy exceeds the taken one by K s^2 n.
  constexpr double kK = 1000, kStep = 1e-4;
  constexpr int kSteps = 40;
  EnergyMeter meter;
  for (int j = 0; j <= kSteps; ++j) meter.add(wallSample(-j * kStep, 0, kK, 0));
  EXPECT_NEAR(meter.ledger.absorbed, 0.5 * kK * kStep * kStep * kSteps * (kSteps - 1), 1e-15);
  EXPECT_EQ(meter.ledger.lowest_absorbed, 0);
  for (int j = kSteps - 1; j >= 0; --j) meter.add(wallSample(-j * kStep, 0, kK, 0));
  EXPECT_NEAR(meter.ledger.absorbed, -kK * kStep * kStep * kSteps, 1e-15);
  EXPECT_NEAR(meter.ledger.lowest_absorbed, meter.ledger.absorbed, 1e-15);
}

TEST(EnergyMeter, DamperKeepsTheWorkOfItsForce) {
  // Half a sine into the wall: work of B v along the path = B a^2 w pi / 2, to the order of T.
  constexpr double kB = 5, kA = 2e-3, kOmega = 20, kT = 1e-5;
  EnergyMeter meter;
  for (double t = 0; t < M_PI / kOmega; t += kT)
    meter.add(wallSample(-kA * std::sin(kOmega * t), -kA * kOmega * std::cos(kOmega * t), 0, kB));
  const double expected = 0.5 * M_PI * kB * kA * kA * kOmega;
  EXPECT_NEAR(meter.ledger.absorbed, expected, 1e-3 * expected);
}

TEST(EnergyMeter, StartsAtZeroWithAForceOnRequest) {
  for (const bool each : {false, true}) {
    EnergyMeter meter;
    meter.from_each_touch = each;
    const double taken = 1e-3; // 1 N over 1 mm, twice
    for (int touch = 0; touch < 2; ++touch) {
      ToolSample sample;
      meter.add(sample);
      sample.force = Vec3(1, 0, 0);
      meter.add(sample);
      sample.tip = Vec3(-1e-3, 0, 0);
      sample.force.setZero();
      meter.add(sample);
    }
    EXPECT_NEAR(meter.ledger.absorbed, each ? taken : 2 * taken, 1e-15);
  }
}

TEST(EnergyMeter, DoesNotCountMissedSamples) {
  EnergyMeter meter;
  ToolSample sample;
  sample.force = Vec3(1, 0, 0);
  meter.add(sample);
  meter.skip();
  sample.tip = Vec3(-1, 0, 0);
  meter.add(sample);
  EXPECT_EQ(meter.ledger.absorbed, 0);
  meter.ledger = {};
  sample.tip = Vec3(-2, 0, 0);
  meter.add(sample);
  EXPECT_NEAR(meter.ledger.absorbed, 1, 1e-15);
}

} // namespace
} // namespace patina
