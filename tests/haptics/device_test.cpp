#include "haptics/device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

namespace patina {
namespace {

constexpr double kPeriod = 1e-3;

SimulatedDeviceSpec massOnly(double mass, double damping) {
  SimulatedDeviceSpec spec;
  spec.mass = mass;
  spec.damping = damping;
  return spec;
}

// x(t) and v(t) of m x'' + b x' = F from rest, F constant.
TEST(SimulatedDevice, FollowsTheClosedFormUnderAConstantForce) {
  const double m = 0.1, b = 0.5, f = 2.0;
  const auto device = makeSimulatedDevice(massOnly(m, b));
  Vec3 tip;
  const int steps = 700;
  for (int i = 0; i < steps; ++i) tip = device->exchange(Vec3(f, 0, -f), kPeriod).tip;
  const double t = steps * kPeriod;
  const double expected = f / b * (t - m / b * -std::expm1(-b * t / m));
  EXPECT_NEAR(tip.x(), expected, 1e-12);
  EXPECT_NEAR(tip.z(), -expected, 1e-12);
  EXPECT_EQ(tip.y(), 0.0);
}

// T-ST1: a held force gives the same motion however finely its period is stepped.
TEST(SimulatedDevice, DoesNotDependOnSubsteps) {
  for (const int substeps : {10, 100}) {
    const auto whole = makeSimulatedDevice(massOnly(0.1, 0.5));
    const auto fine = makeSimulatedDevice(massOnly(0.1, 0.5));
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    for (int i = 0; i < 2000; ++i) {
      const Vec3 force(std::sin(0.1 * i), -300 * a.y(), 1);
      a = whole->exchange(force, kPeriod).tip;
      for (int k = 0; k < substeps; ++k) b = fine->exchange(force, kPeriod / substeps).tip;
    }
    EXPECT_LT((a - b).norm(), 1e-9) << substeps;
  }
}

TEST(HeldForceStep, IsContinuousWhereItsSeriesTakesOver) {
  // b dt / m just below and above 1e-4, and the limit without damping: a = 1, c = T, d = T^2/2m, e
  // = T/m.
  const double m = 0.1;
  const HeldForceStep below = heldForceStep(m, 0.99999e-2, kPeriod);
  const HeldForceStep above = heldForceStep(m, 1.00001e-2, kPeriod);
  EXPECT_NEAR(below.d, above.d, 1e-5 * below.d);
  EXPECT_NEAR(below.c, above.c, 1e-5 * below.c);
  const HeldForceStep none = heldForceStep(m, 0, kPeriod);
  EXPECT_EQ(none.a, 1.0);
  EXPECT_DOUBLE_EQ(none.c, kPeriod);
  EXPECT_DOUBLE_EQ(none.d, kPeriod * kPeriod / (2 * m));
  EXPECT_DOUBLE_EQ(none.e, kPeriod / m);
}

// F3, table 2.1.2: the loop of a sampled spring decays below K* = (1-a)/(ce-ad) and grows above it.
TEST(SimulatedDevice, LosesStabilityAtTheExactZeroOrderHoldBoundary) {
  const double m = 0.1, b = 0.5;
  const HeldForceStep s = heldForceStep(m, b, kPeriod);
  const double limit = (1 - s.a) / (s.c * s.e - s.a * s.d);
  EXPECT_NEAR(limit, 1000.83, 0.01);
  for (const double ratio : {0.99, 1.01}) {
    SimulatedDeviceSpec spec = massOnly(m, b);
    spec.position = Vec3(1e-3, 0, 0);
    const auto device = makeSimulatedDevice(spec);
    Vec3 tip = spec.position;
    double early = 0, late = 0;
    for (int i = 0; i < 60000; ++i) {
      tip = device->exchange(Vec3(-ratio * limit * tip.x(), 0, 0), kPeriod).tip;
      if (i < 1000) early = std::max(early, std::abs(tip.x()));
      if (i >= 59000) late = std::max(late, std::abs(tip.x()));
    }
    if (ratio < 1) {
      EXPECT_LT(late, 0.5 * early);
    } else {
      EXPECT_GT(late, 2 * early);
    }
  }
}

TEST(SimulatedDevice, RefusesAMassThatIsNotPositive) {
  EXPECT_THROW(makeSimulatedDevice(massOnly(0, 1)), std::invalid_argument);
  EXPECT_THROW(makeSimulatedDevice(massOnly(1, -1)), std::invalid_argument);
  EXPECT_THROW(makeSimulatedDevice(massOnly(std::numeric_limits<double>::quiet_NaN(), 1)),
               std::invalid_argument);
}

TEST(ReplayDevice, PlaysEveryTipOnceAndThenHoldsTheLast) {
  const auto device = makeReplayDevice({Vec3(1, 0, 0), Vec3(2, 0, 0)});
  const DeviceState first = device->exchange(Vec3::Zero(), kPeriod);
  EXPECT_EQ(first.tip.x(), 1);
  EXPECT_FALSE(first.finished);
  for (int i = 0; i < 3; ++i) {
    const DeviceState next = device->exchange(Vec3::Zero(), kPeriod);
    EXPECT_EQ(next.tip.x(), 2);
    EXPECT_TRUE(next.finished);
  }
  EXPECT_THROW(makeReplayDevice({}), std::invalid_argument);
}

TEST(MouseDevice, NeverMovesFasterThanItsLimitAndArrives) {
  const auto mouse = makeMouseDevice(Vec3::Zero(), 0.5);
  mouse->setTarget(Vec3(0.05, 0, 0));
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < 400; ++i) {
    const Vec3 tip = mouse->exchange(Vec3::Zero(), kPeriod).tip;
    EXPECT_LE((tip - last).norm(), 0.5 * kPeriod * (1 + 1e-12));
    last = tip;
  }
  EXPECT_NEAR(last.x(), 0.05, 1e-6);
}

TEST(MouseDevice, IgnoresATargetThatIsNotFinite) {
  const auto mouse = makeMouseDevice(Vec3(0, 0, 0.01));
  mouse->setTarget(Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  EXPECT_EQ(mouse->exchange(Vec3::Zero(), kPeriod).tip, Vec3(0, 0, 0.01));
}

TEST(MouseDevice, NeverReadsHalfOfATarget) {
  // Every target lies on the diagonal; a torn read would leave it.
  const auto mouse = makeMouseDevice(Vec3::Zero(), 1e9);
  std::thread writer([&] {
    for (int i = 1; i <= 20000; ++i) mouse->setTarget(Vec3::Constant(i));
  });
  for (int i = 0; i < 20000; ++i) {
    const Vec3 tip = mouse->exchange(Vec3::Zero(), kPeriod).tip;
    ASSERT_EQ(tip.x(), tip.y());
    ASSERT_EQ(tip.x(), tip.z());
  }
  writer.join();
}

} // namespace
} // namespace patina
