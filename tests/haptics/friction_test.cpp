#include "haptics/contact_fixture.h"

#include <gtest/gtest.h>

#include <vector>

#include "haptics/law/friction_stage.h"
#include "haptics/neutral_stages.h"
#include "support/constants.h"
#include "support/simulated_device.h"

namespace patina {
namespace {

using test::kPeriod;
using test::kPi;

double tangential(const Contact& contact) {
  return Vec3(contact.force - contact.force.dot(contact.normal) * contact.normal).norm();
}

// In contact at (0, 0, -depth), at rest.
ContactMemory pressedMemory(const HapticSnapshot& snapshot, double depth) {
  ContactMemory memory;
  tick(snapshot, memory, Vec3(0, 0, 1e-4), kPeriod);
  tick(snapshot, memory, Vec3(0, 0, -depth), kPeriod);
  return memory;
}

// T-K09a: elastic to mu d, then plastic; static and dynamic coefficients equal.
TEST(Friction, IsElasticThenPlasticOnAPlane) {
  const double K = 500, mu = 0.4, d = 2e-3;
  const auto snapshot = compileStages(withFriction(sceneOf(K), mu, mu), planeField());
  ContactMemory memory = pressedMemory(*snapshot, d);
  for (double s = 0; s < 3e-3; s += 0.01e-3) {
    const Contact contact = tick(*snapshot, memory, Vec3(s, 0, -d), kPeriod);
    EXPECT_NEAR(contact.force.x(), -std::min(K * s, mu * K * d), 1e-6) << s;
    EXPECT_NEAR(contact.force.z(), K * d, 1e-6);
  }
}

// K09: mu_s d is needed to break loose, then mu_d d acts until the motion reverses.
TEST(Friction, SlipPersistsAtTheDynamicCoefficient) {
  const double K = 500, d = 2e-3;
  for (const auto slip : {Friction::SlipDirection::paper, Friction::SlipDirection::displacement}) {
    Scene scene = withFriction(sceneOf(K), 0.5, 0.3);
    scene.haptics.friction->slip = slip;
    const auto snapshot = compileStages(scene, planeField());
    ContactMemory memory = pressedMemory(*snapshot, d);
    double s = 0, peak = 0;
    for (; s < 4e-3; s += 0.01e-3) {
      const Contact contact = tick(*snapshot, memory, Vec3(s, 0, -d), kPeriod);
      peak = std::max(peak, -contact.force.x());
      if (s > 0.5 * d + 0.02e-3) {
        EXPECT_NEAR(contact.force.x(), -0.3 * K * d, 1e-6);
      }
    }
    EXPECT_NEAR(peak, 0.5 * K * d, K * 0.011e-3);
    // Back by a little: elastic again, no jump.
    const double reversed = tick(*snapshot, memory, Vec3(s - 0.06e-3, 0, -d), kPeriod).force.x();
    EXPECT_NEAR(reversed, -0.3 * K * d + K * 0.05e-3, 1e-6);
    EXPECT_FALSE(memory.friction.slipping());
  }
}

// T-K09b: a cycle of amplitude A > mu d dissipates 4 mu K d (A - mu d).
TEST(Friction, DissipatesTheClosedFormEnergyPerCycle) {
  const double K = 500, mu = 0.4, d = 2e-3, frequency = 2;
  const auto snapshot = compileStages(withFriction(sceneOf(K), mu, mu), planeField());
  for (const double amplitude : {1e-3, 2e-3, 5e-3}) {
    ContactMemory memory = pressedMemory(*snapshot, d);
    double energy = 0, last_force = 0, last_x = 0;
    const int cycle = 500;
    for (int i = 0; i <= 3 * cycle; ++i) {
      const double x = amplitude * std::sin(2 * kPi * frequency * kPeriod * i);
      const double force = tick(*snapshot, memory, Vec3(x, 0, -d), kPeriod).force.x();
      if (i > 2 * cycle) energy -= 0.5 * (force + last_force) * (x - last_x);
      last_force = force;
      last_x = x;
    }
    const double expected = 4 * mu * K * d * (amplitude - mu * d);
    EXPECT_NEAR(energy, expected, 0.01 * expected) << amplitude;
  }
}

// T-K09c: a mass on a slope of angle theta under its own weight sticks iff tan theta <= mu_s, and
// then does not creep.
TEST(Friction, RestsOnASlopeWithoutCreep) {
  const double mu = 0.5, weight = 1;
  const auto snapshot = compileStages(withFriction(sceneOf(500), mu, 0.3), planeField());
  for (const double tangent : {0.9 * mu, 0.99 * mu, 1.05 * mu}) {
    const double theta = std::atan(tangent);
    SimulatedDeviceSpec spec;
    spec.mass = 0.1;
    spec.damping = 5; // settles within the ramp; 0.5 needs half a minute
    spec.position = Vec3(0, 0, -weight * std::cos(theta) / 500);
    SimulatedDevice device(spec);
    ContactMemory memory;
    Vec3 tip = spec.position, force = Vec3::Zero();
    Vec3 after_settling = tip;
    // Gravity in the frame of the slope rises slowly, so that there is no impact at the start.
    const int ramp = 2000, settle = 6000, end = settle + 60000;
    for (int i = 0; i < end; ++i) {
      const double share = std::min(1.0, static_cast<double>(i) / ramp);
      const Vec3 load(share * weight * std::sin(theta), 0, -weight * std::cos(theta));
      tip = device.exchange(force + load, kPeriod).position;
      if (tip.x() > 5e-3) break; // it slides
      force = tick(*snapshot, memory, tip, kPeriod).force;
      if (i == settle) after_settling = tip;
    }
    if (tangent <= mu) {
      EXPECT_LT((tip - after_settling).norm(), 1e-9) << tangent;
    } else {
      EXPECT_GT(tip.x(), 5e-3) << tangent;
    }
  }
}

// T-K09d / K10: with the depth gain, F_t(2d) / F_t(d) = 2 (1 + 2g) / (1 + g), g = gamma d / d_ref.
TEST(Friction, DepthGainFollowsItsClosedForm) {
  const double d = 1.5e-3;
  for (const double gamma : {0.0, 0.3, 2.0}) {
    const auto snapshot = compileStages(withFriction(sceneOf(500), 0.3, 0.3, gamma), planeField());
    const auto sliding = [&](double depth) {
      ContactMemory memory = pressedMemory(*snapshot, depth);
      return tangential(glide(*snapshot, memory, Vec3(12e-3, 0, -depth)));
    };
    const double g = gamma * d / 1e-3;
    EXPECT_NEAR(sliding(2 * d) / sliding(d), 2 * (1 + 2 * g) / (1 + g), 1e-5);
  }
}

// T-K09e: stick-slip of a mass dragged by a spring. The closed form is for rigid friction: the
// tangential spring of the model (K = 20 kN/m against k = 200 N/m) shifts it by about k / K, and
// its ringing in stick has to be damped, or it breaks loose early.
TEST(Friction, StickSlipPeriodFollowsItsClosedForm) {
  const double m = 0.1, k = 200, K = 20000, normal = 2, F_s = 1.2, F_k = 0.8;
  const double d = normal / K, dt = 1e-5;
  Scene scene = withFriction(sceneOf(K), F_s / normal, F_k / normal);
  scene.haptics.damping = 20;
  const auto snapshot = compileStages(scene, planeField(0x1p-9)); // 62 mm to either side
  for (const double V : {0.005, 0.02, 0.05}) {
    const double w = std::sqrt(k / m), A = (F_s - F_k) / k;
    const double expected = 2 * A / V + 2 / w * (kPi - std::atan(A * w / V));
    SimulatedDeviceSpec spec;
    spec.mass = m;
    spec.damping = 0.02; // against the sampled spring's own gain, K dt / 2
    SimulatedDevice device(spec);
    ContactMemory memory;
    tick(*snapshot, memory, Vec3(0, 0, 1e-5), dt);
    glide(*snapshot, memory, Vec3(0, 0, -d), 1e-6, dt);
    double x = 0, friction = 0, last_onset = 0;
    bool was_slipping = false;
    std::vector<double> periods;
    for (int i = 0; i * dt < 6.5 * expected; ++i) { // the held depth keeps the normal force
      const double t = i * dt;
      x = device.exchange(Vec3(friction + k * (V * t - x), 0, 0), dt).position.x();
      friction = tick(*snapshot, memory, Vec3(x, 0, -d), dt).force.x();
      const bool onset = memory.friction.slipping() && !was_slipping;
      was_slipping = memory.friction.slipping();
      if (!onset || t - last_onset < 0.3 * expected) continue;
      if (last_onset > 0) periods.push_back(t - last_onset);
      last_onset = t;
    }
    ASSERT_GE(periods.size(), 3u) << V;
    EXPECT_NEAR(periods.back() / expected, 1, 0.02) << V;
  }
}

// K09: mu = 0 is the frictionless path bit for bit.
TEST(Friction, ZeroIsBitwiseTheFrictionlessPath) {
  const Field sphere = sphereField();
  const auto without = compileStages(sceneOf(500), sphere);
  const auto with = withNeutralStages(withFriction(sceneOf(500), 0, 0), sphere);
  ContactMemory a, b;
  std::mt19937 random(1);
  Vec3 tip(0, 0, 0.0305);
  for (int i = 0; i < 20000; ++i) {
    tip =
        (0.028 + 0.0025 * std::sin(0.01 * i)) * (tip + 1e-4 * randomDirection(random)).normalized();
    const Contact first = tick(*without, a, tip, kPeriod);
    const Contact second = tick(*with, b, tip, kPeriod);
    ASSERT_EQ(first.force, second.force);
    ASSERT_EQ(first.vcp, second.vcp);
    ASSERT_EQ(first.fault, second.fault);
  }
}

TEST(Friction, ForgetsTheStuckPointOutOfContact) {
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.8, 0.8), planeField());
  ContactMemory memory = pressedMemory(*snapshot, 2e-3);
  EXPECT_GT(tangential(glide(*snapshot, memory, Vec3(1e-3, 0, -2e-3))), 0.1);
  glide(*snapshot, memory, Vec3(1e-3, 0, 1e-4));
  EXPECT_FALSE(memory.friction.stick);
  EXPECT_LT(tangential(tick(*snapshot, memory, Vec3(1e-3, 0, -1e-3), kPeriod)), 1e-12);
}

// T-K10, first reading: Coulomb alone already grows with depth.
TEST(Friction, GrowsWithDepth) {
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.3, 0.3), planeField());
  ContactMemory memory = pressedMemory(*snapshot, 1e-3);
  const double shallow = tangential(glide(*snapshot, memory, Vec3(5e-3, 0, -1e-3)));
  memory = pressedMemory(*snapshot, 3e-3);
  const double deep = tangential(glide(*snapshot, memory, Vec3(5e-3, 0, -3e-3)));
  EXPECT_NEAR(shallow, 0.3 * 500 * 1e-3, 1e-6);
  EXPECT_NEAR(deep, 3 * shallow, 1e-6);
}

// On a curved surface the dragged contact point stays on it, at exactly mu_d d from the candidate.
TEST(Friction, DraggedVcpStaysOnTheSurface) {
  const Field sphere = sphereField();
  const FieldSampler surface(*sphere, Sampler::high);
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.5, 0.3), sphere);
  ContactMemory memory;
  tick(*snapshot, memory, Vec3(0, 0, 0.0301), kPeriod);
  for (int i = 0; i < 4000; ++i) {
    const double angle = 1e-4 * i;
    const Vec3 tip = 0.028 * Vec3(std::sin(angle), 0, std::cos(angle));
    const Contact contact = tick(*snapshot, memory, tip, kPeriod);
    if (i < 1000) continue;
    EXPECT_LT(std::abs(surface.at(contact.vcp).phi), 1e-7);
    EXPECT_NEAR((contact.vcp - contact.frictionless_point).norm(), 0.3 * contact.depth, 1e-10);
    EXPECT_TRUE(memory.friction.slipping());
  }
}

// The projection onto a curved surface must not look like a stop, however slow the motion is.
TEST(Friction, CreepingSlipOnACurveDoesNotChatter) {
  for (const auto slip : {Friction::SlipDirection::paper, Friction::SlipDirection::displacement}) {
    Scene scene = withFriction(sceneOf(500), 0.5, 0.3);
    scene.haptics.friction->slip = slip;
    const auto snapshot = compileStages(scene, sphereField());
    ContactMemory memory;
    tick(*snapshot, memory, Vec3(0, 0, 0.0301), kPeriod);
    for (double angle = 0; angle < 0.05; angle += 1e-4) {
      tick(*snapshot, memory, 0.028 * Vec3(std::sin(angle), 0, std::cos(angle)), kPeriod);
    }
    int stuck = 0;
    for (int i = 0; i < 5000; ++i) { // 0.3 um a tick
      const double angle = 0.05 + 1e-5 * i;
      tick(*snapshot, memory, 0.028 * Vec3(std::sin(angle), 0, std::cos(angle)), kPeriod);
      stuck += !memory.friction.slipping();
    }
    EXPECT_EQ(stuck, 0);
  }
}

// MATH 2.6: sign(v) friction chatters about zero velocity; the clamped contact point comes to rest.
TEST(Friction, MassComesToRestWithoutChatter) {
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.5, 0.5), planeField());
  SimulatedDeviceSpec spec;
  spec.mass = 0.1;
  spec.damping = 0.5;
  spec.position = Vec3(-5e-3, 0, -2e-3);
  spec.velocity = Vec3(0.1, 0, 0);
  spec.hand_force = Vec3(0, 0, -1);
  SimulatedDevice device(spec);
  ContactMemory memory;
  Vec3 tip = spec.position, last = tip, force = Vec3::Zero();
  for (int i = 0; i < 10000; ++i) {
    last = tip;
    tip = device.exchange(force, kPeriod).position;
    force = tick(*snapshot, memory, tip, kPeriod).force;
  }
  EXPECT_LT((tip - last).norm() / kPeriod, 1e-6);
}

// MATH 2.6: a wall with damping along the normal alone would still buzz in stick.
TEST(Friction, DampingActsOnTheStuckPoint) {
  Scene scene = withFriction(sceneOf(1500), 2, 2);
  scene.haptics.damping = 1.5;
  const auto snapshot = compileStages(scene, planeField());
  SimulatedDeviceSpec spec;
  spec.mass = 0.1;
  spec.damping = 0.5; // 2 b / T = 1000 N/m < K: only the damping of the contact can settle it
  spec.position = Vec3(0, 0, -2e-3);
  spec.velocity = Vec3(0.02, 0, 0);
  spec.hand_force = Vec3(0, 0, -3);
  SimulatedDevice device(spec);
  ContactMemory memory;
  Vec3 tip = spec.position, last = tip, force = Vec3::Zero();
  for (int i = 0; i < 8000; ++i) {
    last = tip;
    tip = device.exchange(force, kPeriod).position;
    force = tick(*snapshot, memory, tip, kPeriod).force;
  }
  EXPECT_LT((tip - last).norm() / kPeriod, 1e-6);
}

// In a groove both walls bear more than their sum: mu N / sin(alpha) at half an opening of alpha,
// at any tip position across the groove.
TEST(Friction, TwoWallsGripByTheWedgeFactor) {
  const double mu = 0.3, d = 2e-3;
  for (const double opening : {90.0, 60.0})
    for (const double aside : {0.0, 0.4e-3}) {
      const double alpha = 0.5 * opening * kPi / 180;
      const Vec3 left(std::cos(alpha), 0, std::sin(alpha)), right(-left.x(), 0, left.z());
      Contact contact;
      contact.touching = true;
      contact.dt = kPeriod;
      contact.tip = Vec3(aside, 0, -d);
      contact.depth = contact.tip.norm();
      contact.normal = -contact.tip / contact.depth;
      const double both = d / left.z(), more = -aside / left.x();
      contact.walls = 2;
      contact.wall = {{{left, 0.5 * (both + more)}, {right, 0.5 * (both - more)}}};
      ASSERT_LT(
          (contact.wall[0].multiplier * left + contact.wall[1].multiplier * right + contact.tip)
              .norm(),
          1e-12);
      contact.material.static_friction = contact.material.dynamic_friction = mu;
      const Field groove =
          cubeField([=](const Vec3& p) { return std::min(left.dot(p), right.dot(p)); }, 0.4e-3, 80);
      const FrictionStage stage(FieldSampler(*groove, Sampler::high), 0, Friction{}, false);
      const double reach = mu * d / std::sin(alpha);
      for (const double dragged : {0.99 * reach, 1.01 * reach, 5 * reach}) {
        ContactMemory memory;
        memory.friction.stick = FrictionMemory::StickState{Vec3(0, -dragged, 0),
                                                           contact.frictionless_point, contact.tip};
        Contact now = contact;
        stage.apply(now, memory);
        EXPECT_EQ(memory.friction.slipping(), dragged > reach) << opening;
        EXPECT_NEAR(now.vcp.norm(), std::min(dragged, reach), 1e-9) << opening;
      }
    }
}

// Pressed past the axis of a bar the contact point runs round it by itself. The hand does not slip
// then: the stuck point goes along, and the drag is unchanged.
TEST(Friction, SnapMovesTheStuckPointAlong) {
  const double radius = 3e-3;
  const Field bar =
      cubeField([=](const Vec3& p) { return std::hypot(p.x(), p.z()) - radius; }, 0.25e-3, 96);
  const auto snapshot = compileStages(withFriction(sceneOf(500), 3, 3), bar);
  ContactMemory memory;
  glide(*snapshot, memory, Vec3(0.4e-3, 0, 4e-3));
  glide(*snapshot, memory, Vec3(0.4e-3, 0, 2e-3), 0.05e-3);
  glide(*snapshot, memory, Vec3(0.4e-3, 0.3e-3, 2e-3), 0.05e-3); // stuck 0.3 mm behind
  const Vec3 tip(0.4e-3, 0.3e-3, -1.5e-3);
  Contact last = glide(*snapshot, memory, tip, 0.1e-3);
  int snaps = 0;
  double way = 0;
  for (int i = 0; i < 500; ++i) {
    const Contact now = tick(*snapshot, memory, tip, kPeriod);
    ASSERT_FALSE(now.fault);
    ASSERT_FALSE(memory.friction.slipping());
    if (now.snap) {
      ++snaps;
      way += (now.frictionless_point - last.frictionless_point).norm();
      ASSERT_LT(((now.vcp - now.frictionless_point) - (last.vcp - last.frictionless_point)).norm(),
                1e-12)
          << i;
    }
    last = now;
  }
  EXPECT_GT(snaps, 20);
  EXPECT_GT(way, radius);
  EXPECT_LT(last.normal.z(), -0.9); // it came out on the far side
  EXPECT_NEAR(last.force.y(), -500 * 0.3e-3, 2e-3);
}

} // namespace
} // namespace patina
