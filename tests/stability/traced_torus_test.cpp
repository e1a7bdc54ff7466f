// T-K13e: purpose of a magnetic surface. A trembling hand traces a torus; with the magnet it stays
// on it for more of the time.
#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "field/construction/build_field.h"
#include "geometry/mesh/shapes.h"
#include "haptics/contact_fixture.h"
#include "support/constants.h"

namespace patina {
namespace {

using test::kPeriod;

constexpr double kMajor = 0.03, kMinor = 0.01; // [m]
constexpr double kMass = 0.1;                  // [kg], device and hand
constexpr double kHandStiffness = 100, kHandDamping = 4;
constexpr double kNoise = 2;     // [N], rms of the force across the path
constexpr double kTremor = 0.05; // [s], correlation time
constexpr double kLaps = 3, kLap = 4;

struct Traced {
  double contact = 0, near = 0; // shares of the time: on the surface; on it or held by the pull
};

// The hand's own spring moves along the top of the torus, at rest on its surface.
Traced traced(const HapticSnapshot& snapshot, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  ContactMemory memory;
  Vec3 x(kMajor, 0, kMinor), v = Vec3::Zero();
  Vec2 noise = Vec2::Zero();
  Traced result;
  const int ticks = static_cast<int>(kLaps * kLap / kPeriod);
  const double keeps = std::exp(-kPeriod / kTremor);
  for (int n = 0; n < ticks; ++n) {
    const double turn = 2 * M_PI * n * kPeriod / kLap;
    const Vec3 out(std::cos(turn), std::sin(turn), 0), along(-out.y(), out.x(), 0);
    const Vec3 target = kMajor * out + kMinor * Vec3::UnitZ();
    const Vec3 speed = 2 * M_PI / kLap * kMajor * along;
    noise = keeps * noise + kNoise / std::sqrt(2.0) * std::sqrt(1 - keeps * keeps) *
                                Vec2(normal(random), normal(random));
    const Contact contact = tick(snapshot, memory, x, kPeriod);
    result.contact += contact.touching;
    result.near += contact.touching || contact.attracted;
    EXPECT_TRUE(contact.force.allFinite());
    const Vec3 push = contact.force + noise[0] * out + noise[1] * Vec3::UnitZ();
    constexpr int kSubsteps = 10;
    for (int k = 0; k < kSubsteps; ++k) {
      const Vec3 hand = kHandStiffness * (target - x) + kHandDamping * (speed - v);
      v += kPeriod / kSubsteps / kMass * (push + hand);
      x += kPeriod / kSubsteps * v;
    }
  }
  result.contact /= ticks;
  result.near /= ticks;
  return result;
}

TEST(TracedTorus, MagnetKeepsATremblingHandOnTheSurface) {
  FieldSpec spec;
  spec.resolution = 120;
  spec.band = 12;
  Progress progress;
  const Field field = withSamples(buildField(torus(kMajor, kMinor, 96, 48), spec, progress).field);
  Scene scene = sceneOf(800);
  scene.haptics.damping = 2;
  const auto off = compileStages(scene, field);
  scene.haptics.magnet = Magnet{4e-3, 1000};
  const auto on = compileStages(scene, field);
  Traced bare, pulled;
  constexpr int kSeeds = 8;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Traced a = traced(*off, seed), b = traced(*on, seed);
    EXPECT_GT(b.near, a.near) << seed;
    bare.contact += a.contact / kSeeds;
    pulled.contact += b.contact / kSeeds;
    pulled.near += b.near / kSeeds;
  }
  std::printf("on the surface %.1f %% of the time without magnet, %.1f %% with; %.1f %% on it or "
              "held by the pull\n",
              100 * bare.contact, 100 * pulled.contact, 100 * pulled.near);
  EXPECT_GT(pulled.contact, bare.contact);
}

} // namespace
} // namespace patina
