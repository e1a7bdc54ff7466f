// The contact list of MATH 2.8, each case with its expected behaviour.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <deque>
#include <limits>

#include "haptics/contact_fixture.h"
#include "haptics/law/limit_stage.h"
#include "support/constants.h"
#include "support/longer.h"
#include "support/simulated_device.h"

namespace patina {
namespace {

using test::kPeriod;
using test::kPi;

constexpr double kLimit = 3.3;

Field wall() {
  static const Field field = planeField(0x1p-10, 96); // 47 mm to either side
  return field;
}

Scene wallScene(double stiffness, double limit = kLimit) {
  Scene scene = sceneOf(stiffness);
  scene.haptics.force_limit = limit;
  return scene;
}

struct Loop {
  double mass = 0.1, damping = 0.5, press = 1;
  int delay = 0;
  double period = kPeriod;
  double offset = 1e-4; // distance of the start from the equilibrium [m]

  // Ratio of the swing in the last tenth to that in the second tenth.
  double growth(const HapticSnapshot& snapshot, double stiffness, int ticks) const {
    SimulatedDeviceSpec spec;
    spec.mass = mass;
    spec.damping = damping;
    spec.hand_force = Vec3(0, 0, -press);
    const double rest = -press / stiffness;
    spec.position = Vec3(0, 0, rest - offset);
    SimulatedDevice device(spec);
    ContactMemory memory;
    std::deque<Vec3> sent(static_cast<std::size_t>(delay) + 1, Vec3(0, 0, press));
    double early = 0, late = 0;
    for (int i = 0; i < ticks; ++i) {
      const Vec3 tip = device.exchange(sent.front(), period).position;
      sent.pop_front();
      sent.push_back(tick(snapshot, memory, tip, period).force);
      EXPECT_LE(sent.back().norm(), kLimit);
      const double swing = std::abs(tip.z() - rest);
      if (i >= ticks / 10 && i < ticks / 5) early = std::max(early, swing);
      if (i >= ticks - ticks / 10) late = std::max(late, swing);
    }
    return late / early;
  }
};

// MATH 2.1.2: the boundary of the sampled wall without delay.
double exactBoundary(double m, double b, double T) {
  const double a = std::exp(-b * T / m), c = (1 - a) * m / b, d = (T - c) / b, e = (1 - a) / b;
  return std::min((1 - a) / (c * e - a * d), 2 * (1 + a) / (d * (1 + a) - c * e));
}

TEST(ContactExtremes, SettlesBelowTheSampledBoundaryAndNotAboveIt) {
  const Loop loop;
  const double limit = 2 * loop.damping / kPeriod;
  for (const double share : {0.5, 0.99}) {
    const double K = share * limit;
    EXPECT_LT(loop.growth(*compileStages(wallScene(K), wall()), K, 40000), 0.9) << share;
  }
  for (const double share : {1.02, 2.0, 10.0}) {
    const double K = share * limit;
    const int ticks = share < 1.5 ? 40000 : share < 5 ? 2000 : 300; // before a limit cycle
    EXPECT_GT(loop.growth(*compileStages(wallScene(K), wall()), K, ticks), 1.1) << share;
  }
}

TEST(ContactExtremes, BoundaryHoldsForLightAndHeavyDevices) {
  for (const double mass : {0.01, 1.0}) {
    Loop loop;
    loop.mass = mass;
    loop.offset = 1e-5;
    const double limit = exactBoundary(mass, loop.damping, kPeriod);
    const int ticks = mass < 0.1 ? 10000 : 200000; // the rate goes with b / m
    const double below = 0.98 * limit, above = 1.02 * limit;
    EXPECT_LT(loop.growth(*compileStages(wallScene(below), wall()), below, ticks), 0.9) << mass;
    EXPECT_GT(loop.growth(*compileStages(wallScene(above), wall()), above, ticks), 1.1) << mass;
  }
}

// MATH 2.1.3: n samples of delay, boundary near b / (T/2 + n T).
TEST(ContactExtremes, DelayLowersTheBoundaryAsPredicted) {
  for (const int delay : {1, 2, 5}) {
    Loop loop;
    loop.delay = delay;
    const double limit = loop.damping / (kPeriod / 2 + delay * kPeriod);
    const double below = 0.95 * limit, above = 1.06 * limit;
    EXPECT_LT(loop.growth(*compileStages(wallScene(below), wall()), below, 40000), 0.95) << delay;
    EXPECT_GT(loop.growth(*compileStages(wallScene(above), wall()), above, 40000), 1.05) << delay;
  }
}

TEST(ContactExtremes, ForceStaysWithinTheLimitWithoutDeviceDamping) {
  Loop loop;
  loop.damping = 0;
  EXPECT_GT(loop.growth(*compileStages(wallScene(1000), wall()), 1000, 20000), 1.1);
}

// F4: restitution of an impact at 1 m/s, which ends deeper than the band.
TEST(ContactExtremes, ImpactBouncesWithThePredictedRestitution) {
  const double m = 0.1, b = 0.5, K = 500;
  const auto snapshot = compileStages(wallScene(K, 100), wall());
  double sum = 0;
  bool deep = false;
  const int phases = 50;
  for (int phase = 0; phase < phases; ++phase) {
    SimulatedDeviceSpec spec;
    spec.mass = m;
    spec.damping = b;
    spec.position = Vec3(0, 0, 1e-3 * phase / phases + 1e-6);
    spec.velocity = Vec3(0, 0, -1);
    SimulatedDevice device(spec);
    ContactMemory memory;
    Vec3 force = Vec3::Zero(), last = spec.position;
    bool touched = false;
    for (int i = 0; i < 1000; ++i) {
      const Vec3 tip = device.exchange(force, kPeriod).position;
      const Contact contact = tick(*snapshot, memory, tip, kPeriod);
      EXPECT_FALSE(contact.fault);
      force = contact.force;
      deep |= contact.deep;
      touched |= contact.touching;
      if (touched && !contact.touching) {
        const double held = std::exp(-b * kPeriod / m); // speed within the last tick, on average
        sum += (tip - last).z() / kPeriod / std::sqrt(held);
        break;
      }
      last = tip;
    }
  }
  const double predicted = std::exp(-kPi * (b - K * kPeriod / 2) / (2 * std::sqrt(K * m)));
  EXPECT_TRUE(deep);
  EXPECT_NEAR(sum / phases / predicted, 1, 0.012);
}

TEST(ContactExtremes, JitteringServoSettles) {
  const auto snapshot = compileStages(wallScene(300), wall());
  SimulatedDeviceSpec spec;
  spec.mass = 0.1;
  spec.damping = 0.5;
  spec.position = Vec3(0, 0, 1e-3);
  spec.hand_force = Vec3(0, 0, -1);
  SimulatedDevice device(spec);
  ContactMemory memory;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> period(0.5e-3, 2e-3);
  Vec3 force = Vec3::Zero(), tip;
  for (int i = 0; i < 20000; ++i) {
    const double dt = period(random);
    tip = device.exchange(force, dt).position;
    const Contact contact = tick(*snapshot, memory, tip, dt);
    EXPECT_FALSE(contact.fault);
    force = contact.force;
  }
  EXPECT_NEAR(tip.z(), -1.0 / 300, 1e-6);
}

TEST(ContactExtremes, MissedTickOf20MsIsAbsorbed) {
  const auto snapshot = compileStages(wallScene(500), wall());
  SimulatedDeviceSpec spec;
  spec.mass = 0.1;
  spec.damping = 0.5;
  spec.position = Vec3(0, 0, -3e-3);
  spec.hand_force = Vec3(0, 0, -1);
  SimulatedDevice device(spec);
  ContactMemory memory;
  Vec3 force = Vec3(0, 0, 1), tip;
  for (int i = 0; i < 30000; ++i) {
    const double dt = i % 5000 == 50 && i < 20000 ? 20e-3 : kPeriod;
    tip = device.exchange(force, dt).position;
    const Contact contact = tick(*snapshot, memory, tip, dt);
    EXPECT_FALSE(contact.fault) << i;
    force = contact.force;
  }
  EXPECT_NEAR(tip.z(), -1.0 / 500, 1e-5);
}

TEST(ContactExtremes, TeleportsOf50MmStayWithinTheLimit) {
  const Field sphere = sphereField(0.03, 100);
  Scene scene = withFriction(wallScene(500), 0.5, 0.3);
  scene.haptics.damping = 2;
  const auto snapshot = compileStages(scene, sphere);
  std::mt19937 random(2);
  ContactMemory memory;
  Vec3 tip(0, 0, 0.04);
  for (int i = 0; i < 20000; ++i) {
    if (i % 50 == 0) tip = 0.05 * randomDirection(random) + 0.01 * randomDirection(random);
    if (i % 50 == 25) tip += 0.05 * randomDirection(random);
    tip += 1e-5 * randomDirection(random);
    const Contact contact = tick(*snapshot, memory, tip, kPeriod);
    EXPECT_LE(contact.force.norm(), kLimit);
  }
}

// The force is finite and within the limit for any tip and period.
TEST(ContactExtremes, AnyTipGivesAFiniteForceWithinTheLimit) {
  const Field plate = plateField();
  Scene scene = withFriction(wallScene(500), 0.5, 0.3, 0.5);
  scene.haptics.damping = 2;
  scene.haptics.tip_radius = 0.1e-3;
  scene.haptics.friction->slip = Friction::SlipDirection::displacement;
  const auto snapshot = compileStages(scene, plate);
  const int count = static_cast<int>(test::longer(1000000));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> coordinate(-5e-3, 5e-3);
  ContactMemory memory;
  std::uint64_t bad = 0;
  Vec3 tip = Vec3::Zero();
  int touching = 0, pressed = 0;
  for (int i = 0; i < count; ++i) {
    if (i % 5000 == 4999) { // contact must still work after such tips
      // A path round the rim and back: a tip that went through the plate is still held on the other
      // side.
      for (const Vec3& corner : {Vec3(8e-3, 0, 0), Vec3(8e-3, 0, 2e-3), Vec3(0, 0, 2e-3)})
        glide(*snapshot, memory, corner, 0.05e-3);
      for (int k = 0; k < 400; ++k) tick(*snapshot, memory, Vec3(0, 0, 1e-3), kPeriod);
      glide(*snapshot, memory, Vec3(0, 0, 0.4e-3), 0.02e-3);
      const Vec3 inside(0, 0, 0.15e-3);
      glide(*snapshot, memory, inside, 0.02e-3);
      for (int k = 0; k < 40; ++k) tick(*snapshot, memory, inside, kPeriod);
      const Contact calm = tick(*snapshot, memory, inside, kPeriod);
      ASSERT_FALSE(calm.fault) << i;
      // The plate's top is at 0.25 mm, the tip's radius 0.1 mm.
      ASSERT_NEAR(calm.force.z(), 500 * 0.2e-3, 1e-5) << i;
      ++pressed;
      tip = inside;
    }
    const auto kind = random() % 64;
    if (kind < 40) {
      tip =
          tip.allFinite()
              ? Vec3(tip + 0.02 * Vec3(coordinate(random), coordinate(random), coordinate(random)))
              : Vec3::Zero();
      if (tip.cwiseAbs().maxCoeff() > 4e-3) tip *= 0.1;
    } else if (kind < 60) {
      tip = Vec3(coordinate(random), coordinate(random), coordinate(random));
    } else { // any bit pattern: NaN, infinite, denormal, 1e300
      std::uint64_t bits[3] = {random(), random(), random()};
      if (kind == 60) bits[0] &= 0x000fffffffffffffULL;
      if (kind == 61) bits[1] |= 0x7ff0000000000000ULL;
      std::memcpy(tip.data(), bits, sizeof(bits));
    }
    bad += !tip.allFinite();
    double dt = kPeriod;
    if (kind == 1) dt = 0;
    if (kind == 2) dt = std::numeric_limits<double>::denorm_min();
    if (kind == 3) dt = std::nan("");
    if (kind == 4) dt = 1e300;
    const Contact contact = tick(*snapshot, memory, tip, dt);
    touching += contact.touching;
    ASSERT_TRUE(contact.force.allFinite()) << i;
    ASSERT_LE(contact.force.norm(), kLimit) << i;
  }
  EXPECT_EQ(pressed, count / 5000);
  EXPECT_GT(bad, static_cast<std::uint64_t>(count) / 100);
  EXPECT_GT(touching, count / 20);
}

// A tick without duration, or a tip set beyond all bounds, must not leave a velocity.
TEST(ContactExtremes, ForgetsAnImpossibleVelocity) {
  Scene scene = wallScene(500);
  scene.haptics.damping = 2;
  const auto snapshot = compileStages(scene, wall());
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const auto& [z, dt] : std::vector<std::pair<double, double>>{
           {1e-3, tiny}, {1e-3, 1e-300}, {1e306, kPeriod}, {-1e306, 1e-5}, {1e200, kPeriod}}) {
    ContactMemory memory;
    tick(*snapshot, memory, Vec3(0, 0, 2e-3), kPeriod);
    tick(*snapshot, memory, Vec3(0, 0, z), dt);
    EXPECT_TRUE(memory.filter.velocity.allFinite()) << z << ' ' << dt;
    for (int i = 0; i < 60; ++i) tick(*snapshot, memory, Vec3(0, 0, 1e-3), kPeriod);
    glide(*snapshot, memory, Vec3(0, 0, -2e-3), 0.1e-3);
    for (int i = 0; i < 30; ++i) tick(*snapshot, memory, Vec3(0, 0, -2e-3), kPeriod);
    const Contact contact = tick(*snapshot, memory, Vec3(0, 0, -2e-3), kPeriod);
    EXPECT_FALSE(contact.fault);
    EXPECT_NEAR(contact.force.z(), 1.0, 1e-4) << z << ' ' << dt;
  }
}

// A tip at rest has the same force after a million ticks, bit for bit, with every stage on.
TEST(ContactExtremes, DoesNotDrift) {
  Scene scene = withFriction(wallScene(500), 0.5, 0.3);
  scene.haptics.damping = 2;
  const auto snapshot = compileStages(scene, sphereField(0.03, 100));
  ContactMemory memory;
  glide(*snapshot, memory, Vec3(0, 0, 0.031));
  glide(*snapshot, memory, Vec3(0.001, 0.002, 0.0285));
  const Vec3 tip(0.0012, 0.0023, 0.0285);
  glide(*snapshot, memory, tip);
  for (int i = 0; i < 1000; ++i) tick(*snapshot, memory, tip, kPeriod);
  const Vec3 first = tick(*snapshot, memory, tip, kPeriod).force;
  for (int i = 0; i < 1000000; ++i) tick(*snapshot, memory, tip, kPeriod);
  EXPECT_EQ(tick(*snapshot, memory, tip, kPeriod).force, first);
  EXPECT_GT(first.norm(), 0.5);
}

// Tips exactly on nodes, edges and faces of cells, and on the medial axes of a box.
TEST(ContactExtremes, SpecialPointsAreFiniteAndConsistent) {
  const Vec3 half(8e-3, 8e-3, 8e-3);
  const Field box = cubeField([&](const Vec3& p) { return boxDistance(p, half); }, 0.5e-3, 64);
  const auto snapshot = compileStages(wallScene(100), box);
  for (int x = -16; x <= 16; ++x)
    for (int y = -16; y <= 16; y += 4)
      for (int z = -16; z <= 16; ++z) {
        const Vec3 tip = 0.5e-3 * Vec3(x, y, z);
        const Contact contact = touchOnce(*snapshot, tip);
        EXPECT_TRUE(contact.force.allFinite());
        const double depth = -boxDistance(tip, half);
        EXPECT_EQ(contact.touching, depth > 0);
        EXPECT_LE(contact.force.norm(), std::min(kLimit, 100 * 2.2 * (depth + 1e-3))) << tip;
      }
}

} // namespace
} // namespace patina
