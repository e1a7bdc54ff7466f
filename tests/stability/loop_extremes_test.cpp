// The closed loop under disturbances: MATH 2.8, contact.
#include <gtest/gtest.h>

#include <cmath>

#include "stability/loop_support.h"

namespace patina {
namespace {

const Wall kStiff{.stiffness = 1e5, .stabilisers = std::nullopt};

SimulationSpec pressedAt(double speed) {
  SimulationSpec spec;
  spec.press = 1;
  spec.speed = speed;
  return spec;
}

TEST(LoopExtremes, SettlesUnderAJitteringServo) {
  for (const unsigned seed : {1u, 2u, 3u, 4u})
    for (const double stiffness : {400., 900., 1e5, 1e7}) {
      SimulationSpec spec = pressedAt(.2);
      spec.jitter = PeriodRange{0.5e-3, 2e-3};
      spec.seed = seed;
      const SimulationReport run =
          runOn({.stiffness = stiffness, .stabilisers = std::nullopt}, spec);
      EXPECT_TRUE(run.stable) << stiffness << " " << seed;
      if (stiffness >= 900) {
        EXPECT_LT(run.rms_velocity, 1e-9) << stiffness << " " << seed;
      }
    }
}

TEST(LoopExtremes, JitterIsTheSameAgainWithTheSameSeed) {
  SimulationSpec spec = pressedAt(.2);
  spec.jitter = PeriodRange{0.5e-3, 2e-3};
  const SimulationReport a = runOn(kStiff, spec), b = runOn(kStiff, spec);
  EXPECT_EQ(a.max_depth, b.max_depth);
  spec.seed = 2;
  EXPECT_NE(a.max_depth, runOn(kStiff, spec).max_depth);
}

TEST(LoopExtremes, AbsorbsAMissedTickOf20MsAtRestAndOnEntry) {
  for (const double at : {0.002, 0.004, 0.5, 3.}) {
    SimulationSpec spec = pressedAt(.2);
    spec.missed = MissedTick{at, 0.02};
    const SimulationReport run = runOn(kStiff, spec);
    EXPECT_LT(run.rms_velocity, 1e-9) << at;
    EXPECT_LT(run.max_depth, 0.02) << at;
  }
}

TEST(LoopExtremes, TeleportOf50MmEndsAtRest) {
  for (const double by : {-0.05, 0.05}) {
    SimulationSpec spec = pressedAt(.2);
    spec.seconds = 12;
    spec.teleport = Teleport{2, Vec3(0, 0, by)};
    HapticProperties haptics = propertiesOf(kStiff);
    haptics.force_limit = 3.3;
    Progress progress;
    const auto snapshot =
        planeSnapshot(haptics, planStabilisers(haptics, spec.device, std::nullopt));
    const SimulationReport run = simulate(*snapshot, spec, progress);
    EXPECT_LE(run.max_force, 3.3);
    EXPECT_TRUE(std::isfinite(run.rms_velocity));
    if (by > 0) {
      EXPECT_LT(run.rms_velocity, 1e-9);
    }
    if (by < 0) {
      EXPECT_GT(run.fault_ticks, 0u) << "50 mm deep at once is a fault, not a force";
    }
  }
}

TEST(LoopExtremes, LightHeavyAndUndampedDevicesRest) {
  for (const double mass : {.01, .1, 1.})
    for (const double damping : {0., .5})
      for (const double stiffness : {.5, .99, 1.01, 2., 10., 1000.}) {
        SimulationSpec spec = pressedAt(1); // [m/s]
        spec.device.mass = mass;
        spec.device.damping = damping;
        spec.seconds = 16;
        const double limit = std::max(2 * damping / 1e-3, 100.);
        const SimulationReport run =
            runOn({.stiffness = stiffness * limit, .stabilisers = std::nullopt}, spec);
        EXPECT_TRUE(run.stable) << mass << " " << damping << " " << stiffness;
        EXPECT_EQ(run.fault_ticks, 0u) << mass << " " << damping << " " << stiffness;
      }
}

TEST(LoopExtremes, TenMillionStepsDoNotDrift) {
  SimulationSpec spec = pressedAt(0);
  spec.seconds = 1e4; // 1e7 ticks
  Vec3 end, brief_end;
  const SimulationReport run =
      runOn(kStiff, spec, [&](const SimulationRow& row) { end = row.position; });
  EXPECT_EQ(run.ticks, 10'000'000u);
  EXPECT_LT(run.rms_velocity, 1e-12);
  spec.seconds = 100;
  const SimulationReport brief =
      runOn(kStiff, spec, [&](const SimulationRow& row) { brief_end = row.position; });
  EXPECT_NEAR(end.z(), brief_end.z(), 1e-15);
  EXPECT_NEAR(run.energy.absorbed, brief.energy.absorbed, 1e-12);
  EXPECT_EQ(end.x(), 0);
}

TEST(LoopExtremes, BadSpecsAreRefused) {
  const auto refused = [](auto change) {
    SimulationSpec spec;
    change(spec);
    EXPECT_THROW(runOn({}, spec), std::invalid_argument);
  };
  refused([](auto& s) { s.seconds = 2; });
  refused([](auto& s) { s.device.mass = 0; });
  refused([](auto& s) { s.device.damping = -1; });
  refused([](auto& s) { s.saturation = 0; });
  refused([](auto& s) { s.jitter = PeriodRange{2e-3, 1e-3}; });
  refused([](auto& s) { s.inward = Vec3::Zero(); });
}

} // namespace
} // namespace patina
