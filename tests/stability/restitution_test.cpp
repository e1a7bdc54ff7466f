// A bounce below the boundary gives the effective damping (F4, MATH 2.1.5), and a magnet's cycle
// that of its two sides (F14, T-K13d).
#include <gtest/gtest.h>

#include <cmath>

#include "haptics/contact_fixture.h"
#include "stability/loop_support.h"
#include "support/constants.h"

namespace patina {
namespace {

using test::kPi;

constexpr int kPhases = 200;

struct Bounce {
  double mass = .1, stiffness = 500, damping = .5, virtual_damping = 0;
  double rate = 1000;
};

double predicted(const Bounce& b) {
  const double effective = b.damping + b.virtual_damping - 0.5 * b.stiffness / b.rate;
  return std::exp(-0.5 * kPi * effective / std::sqrt(b.stiffness * b.mass));
}

// Returns the mean over entry phases: the tip starts at different parts of a tick's distance off
// the wall.
double measured(const Bounce& b) {
  double sum = 0;
  for (int i = 0; i < kPhases; ++i) {
    SimulationSpec spec;
    spec.device.mass = b.mass;
    spec.device.damping = b.damping;
    spec.device.rate = b.rate;
    spec.speed = .2;
    spec.depth = -1e-3 - i * spec.speed / b.rate / kPhases;
    spec.seconds = 3;
    sum += runOn({.stiffness = b.stiffness, .damping = b.virtual_damping}, spec)
               .restitution.value_or(std::nan(""));
  }
  return sum / kPhases;
}

TEST(Restitution, FollowsTheEffectiveDampingBelowTheBoundary) {
  const Bounce table[] = {{.1, 200, .5, 0},      {.1, 500, .5, 0},  {.1, 900, .5, 0},
                          {.1, 500, 1, 0},       {.1, 1500, 1, 0},  {.1, 1000, .5, 1},
                          {.1, 2000, .5, 2},     {.05, 500, .5, 0}, {.05, 800, .5, .5},
                          {1, 2000, 5, 2},       {1, 5000, 10, 5},  {.1, 3000, .5, 0, 5000},
                          {.1, 5000, 1, 2, 5000}};
  for (const Bounce& b : table) {
    ASSERT_LE(b.damping / b.mass / b.rate, 0.01);
    ASSERT_LE((b.damping + b.virtual_damping) / (2 * std::sqrt(b.stiffness * b.mass)), 0.12);
    EXPECT_NEAR(measured(b) / predicted(b), 1, 0.02)
        << "m " << b.mass << " K " << b.stiffness << " b " << b.damping << " B "
        << b.virtual_damping;
  }
}

// A sampled spring without any damping returns more speed than the impact had.
TEST(Restitution, IsAboveOneAsPredictedForAnUndampedWall) {
  for (const double stiffness : {200., 1000., 5000.}) {
    const Bounce b{.1, stiffness, 0, 0};
    EXPECT_GT(measured(b), 1);
    EXPECT_NEAR(measured(b) / predicted(b), 1, 0.002) << stiffness;
  }
}

// The formula is the first term of the damped half wave: its error is of the first order in the
// period.
TEST(Restitution, ApproachesTheDampedHalfWaveWithTheRate) {
  for (const double rate : {500., 1000., 2000., 4000., 8000.}) {
    const Bounce b{.1, 400, .8, 0, rate};
    const double share =
        (b.damping - 0.5 * b.stiffness / rate) / (2 * std::sqrt(b.stiffness * b.mass));
    const double exact = std::exp(-kPi * share / std::sqrt(1 - share * share));
    EXPECT_LT(std::abs(measured(b) / exact - 1), 0.5 / rate) << rate;
  }
}

double amplitudeRatio(double inner, double outer, double mass, double damping, double period) {
  const auto side = [&](double k) { return (damping - 0.5 * k * period) / std::sqrt(k * mass); };
  return std::exp(-0.5 * kPi * (side(inner) + side(outer)));
}

// Amplitudes of the outward swings of a free tip released at 1.5 mm.
double ratioPerCycle(const ForceLaw& law, const SimulationSpec& spec) {
  std::vector<double> peaks;
  double before = 0, now = -spec.depth;
  Progress progress;
  SimulationSpec run = spec;
  run.seconds = 3;
  simulate(law, run, progress, [&](const SimulationRow& row) {
    const double next = row.position.z();
    if (now > before && now >= next && now > 0 && row.t > 0.002) peaks.push_back(now);
    before = now;
    now = next;
  });
  // The top of a parabola through three samples differs little from the highest of them; over
  // many cycles the difference vanishes.
  const std::size_t cycles = std::min<std::size_t>(peaks.size() - 1, 12);
  return std::pow(peaks[cycles] / peaks[0], 1.0 / static_cast<double>(cycles));
}

SimulationSpec released(double height) {
  SimulationSpec spec;
  spec.device.rate = 2000;
  spec.depth = -height;
  return spec;
}

// F14, T-K13d, with the law itself: one side may exceed 2b/T if the other compensates.
TEST(MagneticSurface, AmplitudePerCycleFollowsBothSides) {
  const double sides[][2] = {{1500, 500}, {3000, 1500}, {2500, 500}, {800, 800}};
  for (const auto& [inner, outer] : sides) {
    const double k_in = inner, k_out = outer;
    const ForceLaw law = [=](const Vec3& tip, double) {
      LawOutput felt;
      felt.force.z() = -(tip.z() < 0 ? k_in : k_out) * tip.z();
      felt.touching = tip.z() < 0;
      return felt;
    };
    EXPECT_NEAR(ratioPerCycle(law, released(1.5e-3)), amplitudeRatio(inner, outer, .1, .5, 5e-4),
                2e-3)
        << inner << " " << outer;
  }
  EXPECT_NEAR(amplitudeRatio(1500, 500, .1, .5, 5e-4), .9054, 1e-4);
  EXPECT_NEAR(amplitudeRatio(3000, 1500, .1, .5, 5e-4), 1.0067, 1e-4);
}

// The same through the servo's own stages, on a sampled plane.
TEST(MagneticSurface, AmplitudePerCycleFollowsBothSidesThroughTheStages) {
  const double sides[][2] = {{1500, 500}, {3000, 1500}};
  for (const auto& [inner, outer] : sides) {
    Scene scene = sceneOf(inner);
    scene.haptics.magnet = Magnet{3e-3, outer};
    scene.haptics.force_limit = 100;
    const auto snapshot = compileStages(scene, planeField(0x1p-10, 32));
    ContactMemory memory;
    const ForceLaw law = [&](const Vec3& tip, double dt) {
      const Contact contact = tick(*snapshot, memory, tip, dt);
      return LawOutput{contact.force, contact.touching, contact.fault, contact.depth};
    };
    const double height = inner > 2000 ? 0.5e-3 : 1.5e-3; // the second one grows
    EXPECT_NEAR(ratioPerCycle(law, released(height)), amplitudeRatio(inner, outer, .1, .5, 5e-4),
                2e-3)
        << inner << " " << outer;
  }
}

} // namespace
} // namespace patina
