// Coupling, passivity controller and their choice, tick by tick (MATH 2.3).
#include "haptics/law/stabilisers.h"

#include <gtest/gtest.h>

#include "haptics/contact_fixture.h"
#include "haptics/law/coupling_stage.h"
#include "haptics/law/plane.h"
#include "support/constants.h"

namespace patina {
namespace {

using test::kPeriod;

Contact pressTo(const HapticSnapshot& snapshot, ContactMemory& memory, double z) {
  return tick(snapshot, memory, Vec3(0, 0, z), kPeriod);
}

bool hasStage(const HapticSnapshot& snapshot, const std::string& stage) {
  for (const StageInfo& info : snapshot.why)
    if (info.name == stage) return true;
  return false;
}

std::shared_ptr<const HapticSnapshot> coupled(double stiffness, double coupling, double damping) {
  HapticProperties haptics;
  haptics.stiffness = stiffness;
  haptics.force_limit = 1e6;
  StabiliserPlan plan;
  plan.coupling = CouplingPlan{coupling, damping};
  return planeSnapshot(haptics, plan);
}

TEST(Coupling, SeriesOfTwoSpringsHasNoLimitOfStiffness) {
  EXPECT_DOUBLE_EQ(inSeries(300, 600), 200);
  EXPECT_DOUBLE_EQ(inSeries(std::numeric_limits<double>::infinity(), 600), 600);
  EXPECT_NEAR(inSeries(1e300, 600), 600, 1e-9);
  EXPECT_EQ(inSeries(0, 600), 0);
}

TEST(Coupling, HasASpringToTheContactPointAndADamperOfTheTip) {
  const auto snapshot = coupled(1e4, 1000, 2);
  const double k = inSeries(1e4, 1000);
  ContactMemory memory;
  pressTo(*snapshot, memory, 1e-3);
  EXPECT_NEAR(pressTo(*snapshot, memory, -1e-3).force.z(), k * 1e-3 + 2 * 2, 1e-12);
  EXPECT_NEAR(pressTo(*snapshot, memory, -1.2e-3).force.z(), k * 1.2e-3 + 2 * .2, 1e-12);
  EXPECT_NEAR(pressTo(*snapshot, memory, -1.2e-3).force.z(), k * 1.2e-3, 1e-12);
  // On a fast retreat the coupling lets go and does not pull.
  EXPECT_NEAR(pressTo(*snapshot, memory, -0.2e-3).force.z(), 0, 1e-12);
}

TEST(Coupling, ReplacesSpringFilterAndDamping) {
  Scene scene = sceneOf(1e5);
  scene.haptics.damping = 3;
  scene.haptics.damping_cutoff = 200;
  EXPECT_FALSE(hasStage(*compileStages(scene, planeField()), "coupling"));
  scene.device_model = DeviceModel{};
  const auto snapshot = compileStages(scene, planeField());
  for (const char* absent : {"spring", "velocity filter", "damping", "passivity"})
    EXPECT_FALSE(hasStage(*snapshot, absent)) << absent;
  EXPECT_TRUE(hasStage(*snapshot, "coupling"));
  EXPECT_DOUBLE_EQ(snapshot->stabilisers.coupling.value().damping, 3)
      << "the scene's own value is larger";
  ContactMemory memory;
  pressTo(*snapshot, memory, -1e-3);
  EXPECT_NEAR(pressTo(*snapshot, memory, -1e-3).force.z(),
              1e-3 * inSeries(1e5, snapshot->stabilisers.coupling->stiffness), 1e-5);
}

TEST(Coupling, SoftensAndDampsAMagnet) {
  Scene scene = sceneOf(500);
  scene.haptics.magnet = Magnet{2e-3, 1e5};
  scene.device_model = DeviceModel{};
  const auto snapshot = compileStages(scene, planeField());
  ASSERT_TRUE(snapshot->stabilisers.coupling);
  const auto [coupling, damping, most] = *snapshot->stabilisers.coupling;
  EXPECT_GE(most, damping);
  ContactMemory memory;
  pressTo(*snapshot, memory, 1e-3);
  const double still = pressTo(*snapshot, memory, 1e-3).force.z();
  EXPECT_NEAR(still, -1e-3 * inSeries(1e5, coupling), 1e-3);
  const double moved = pressTo(*snapshot, memory, 0.9e-3).force.z();
  EXPECT_NEAR(moved, -0.9e-3 * inSeries(1e5, coupling) + damping * .1, 1e-3);
}

TEST(Stabilisers, AreLeftOutWithoutADeviceAndWithAMarginOfTwo) {
  HapticProperties haptics;
  haptics.stiffness = 1e5;
  EXPECT_FALSE(planStabilisers(haptics, std::nullopt, std::nullopt).coupling);
  EXPECT_FALSE(planStabilisers(haptics, std::nullopt, std::nullopt).predicted_limit);
  const DeviceModel device; // K* = 1000.83
  for (const auto& [stiffness, needed] : {std::pair{499., false}, {501., true}}) {
    haptics.stiffness = stiffness;
    const StabiliserPlan plan = planStabilisers(haptics, device, std::nullopt);
    EXPECT_EQ(plan.coupling.has_value(), needed) << stiffness;
    EXPECT_EQ(plan.why.empty(), !needed);
    EXPECT_NEAR(plan.predicted_limit.value(), 1000.83, .1);
  }
  haptics.damping = 1; // K* = 2973
  EXPECT_FALSE(planStabilisers(haptics, device, std::nullopt).coupling);
  haptics.magnet = Magnet{1e-3, 2000};
  EXPECT_TRUE(planStabilisers(haptics, device, std::nullopt).coupling);
}

TEST(Stabilisers, FollowTheChoice) {
  HapticProperties haptics;
  haptics.stiffness = 1e5;
  const auto none = planStabilisers(haptics, DeviceModel{}, Stabilisers{});
  EXPECT_FALSE(none.coupling || none.passivity);
  const auto both = planStabilisers(haptics, std::nullopt, Stabilisers{true, true});
  EXPECT_TRUE(both.coupling && both.passivity);
  const auto only = planStabilisers(haptics, DeviceModel{}, Stabilisers{false, true});
  EXPECT_TRUE(!only.coupling && only.passivity);
}

// One step of the encoder must not be perceptible through the damper: B step/T.
TEST(Stabilisers, CouplingIsSofterWithACoarseEncoder) {
  DeviceModel fine, coarse;
  coarse.encoder_step = 1e-4;
  const CouplingPlan a = planCoupling({}, fine), b = planCoupling({}, coarse);
  EXPECT_DOUBLE_EQ(a.damping, 1.7);
  EXPECT_DOUBLE_EQ(b.damping, .3);
  EXPECT_LT(b.stiffness, a.stiffness);
  for (const int delay : {0, 1, 2, 5, 20})
    for (const double damping : {0., .5, 50., 500.}) {
      DeviceModel device{.1, damping, 0, 0, 1000, delay};
      const auto [stiffness, virtual_damping, most] = planCoupling({}, device);
      EXPECT_GE(most, virtual_damping);
      SampledLoop loop = sampledLoop(device);
      loop.virtual_damping = virtual_damping;
      EXPECT_GE(stiffness, 0.4 * linearStabilityLimit(loop) * (1 - 1e-12))
          << delay << " " << damping;
      EXPECT_LE(stiffness, 0.75 * stiffnessLimit(loop)) << delay << " " << damping;
    }
}

struct PassivityRun {
  PassivityStage stage;
  ContactMemory memory;
  Vec3 tickAt(double x, const Vec3& force, double stiffness = 0) {
    Contact contact;
    contact.tip = Vec3(x, 0, 0);
    contact.vcp = Vec3::Zero();
    contact.touching = stiffness > 0;
    contact.stiffness = stiffness;
    contact.dt = kPeriod;
    contact.force = force;
    stage.apply(contact, memory);
    memory.tip = {contact.tip, 0, contact.force};
    return contact.force;
  }
};

TEST(Passivity, DissipatesGeneratedEnergyInOneTick) {
  PassivityRun run{PassivityStage({.max_damping = 100}), {}};
  const Vec3 pushes(1, 0, 0);
  EXPECT_EQ(run.tickAt(0, pushes), pushes);
  // 1 N along 0.1 mm gave 0.1 mJ; at 0.1 m/s, alpha = 1e-4 / (1e-3 * 0.01) = 10 N s/m.
  EXPECT_NEAR(run.memory.passivity.energy, 0, 0);
  const Vec3 damped = run.tickAt(1e-4, Vec3::Zero());
  EXPECT_NEAR(run.memory.passivity.energy, -1e-4, 1e-18);
  EXPECT_NEAR(damped.x(), -10 * .1, 1e-12);
  // The generated energy is dissipated at the same speed.
  run.tickAt(2e-4, Vec3::Zero());
  EXPECT_NEAR(run.memory.passivity.energy, 0, 1e-18);
}

TEST(Passivity, NeverDampsMoreThanItsLimit) {
  PassivityRun run{PassivityStage({.max_damping = 5}), {}};
  run.tickAt(0, Vec3(1, 0, 0));
  EXPECT_NEAR(run.tickAt(1e-4, Vec3::Zero()).x(), -5 * .1, 1e-12);
}

TEST(Passivity, ForgetsDissipatedEnergyButKeepsGeneratedEnergy) {
  PassivityRun run{PassivityStage({.max_damping = 100}), {}};
  // An hour of rubbing: 1 N against the motion.
  double x = 0;
  for (int i = 0; i < 1000; ++i) run.tickAt(x += 1e-4, Vec3(-1, 0, 0));
  EXPECT_LE(run.memory.passivity.energy, 0) << "no credit";
  EXPECT_GT(run.memory.passivity.energy, -1e-12);
  // A spring can return at most its stored energy.
  for (int i = 0; i < 100; ++i) run.tickAt(1e-3, Vec3(-1, 0, 0), 1000);
  EXPECT_LE(run.memory.passivity.energy, 0.5 * 1000 * 1e-6 + 1e-15);
  run.memory.passivity.energy = -1e-3;
  run.tickAt(1e-3, Vec3::Zero());
  run.tickAt(1e-3, Vec3::Zero());
  EXPECT_DOUBLE_EQ(run.memory.passivity.energy, -1e-3)
      << "contact ended, the generated energy remains";
}

TEST(Passivity, CountsTheDelayedForce) {
  PassivityRun run{PassivityStage({.max_damping = 0, .delay = 2}), {}};
  // Forces 1, 2, 3, 4 each act for one step, two ticks late.
  const double pushes[] = {1, 2, 3, 4, 0, 0, 0, 0};
  const double given[] = {0, 0, 0, 1e-4, 3e-4, 6e-4, 10e-4, 10e-4};
  for (int i = 0; i < 8; ++i) {
    run.tickAt(1e-4 * i, Vec3(pushes[i], 0, 0));
    EXPECT_NEAR(run.memory.passivity.energy, -given[i], 1e-15) << i;
  }
}

TEST(Passivity, IgnoresRoundingAtRest) {
  HapticProperties haptics;
  haptics.stiffness = 300;
  const auto with =
      planeSnapshot(haptics, planStabilisers(haptics, DeviceModel{}, Stabilisers{false, true}));
  const auto without = planeSnapshot(haptics, {});
  ContactMemory a, b;
  for (int i = 0; i < 100000; ++i) {
    const double z = -1e-3 - (i % 2) * 1e-18;
    ASSERT_EQ(pressTo(*with, a, z).force, pressTo(*without, b, z).force);
  }
}

// The exact plane of `patina simulate` against the sampled one.
TEST(Plane, MatchesTheSampledPlaneToTheSearchTolerance) {
  Scene scene = sceneOf(800);
  scene.haptics.damping = 1;
  const auto sampled = compileStages(scene, planeField());
  const auto exact = planeSnapshot(scene.haptics, {});
  ContactMemory a, b;
  for (int i = 0; i < 400; ++i) {
    const Vec3 tip(2e-4 * std::sin(.05 * i), 1e-4, 1.5e-3 * std::sin(.03 * i));
    const Contact c = tick(*sampled, a, tip, kPeriod), d = tick(*exact, b, tip, kPeriod);
    EXPECT_EQ(c.touching, d.touching);
    EXPECT_NEAR((c.force - d.force).norm(), 0, 1e-6);
    EXPECT_NEAR((c.vcp - d.vcp).norm(), 0, 1e-9); // 2e-6 voxels
  }
  EXPECT_NEAR(pressTo(*exact, b, -50).depth, 50, 0);
  scene.haptics.friction = Friction{.5, .3};
  EXPECT_THROW(planeSnapshot(scene.haptics, {}), std::invalid_argument);
}

// sqrt(2 b B) over the mean age of what is applied, between a tenth of k_c and all of it.
TEST(Stabilisers, LateralCouplingIsAsStiffAsDampingAllows) {
  bool within = false;
  for (const double rate : {1000., 4000.})
    for (const int delay : {0, 1, 3, 6})
      for (const double damping : {0., 0.2, 2.}) {
        const DeviceModel device{.1, damping, 0, 0, rate, delay};
        const CouplingPlan coupling = planCoupling({}, device);
        const double age = 0.5 / rate + delay / rate;
        const double held = std::sqrt(2 * damping * coupling.damping) / age;
        const double stiffness = planLateral({}, device).stiffness;
        EXPECT_NEAR(stiffness,
                    std::min(std::max(held, 0.1 * coupling.stiffness), coupling.stiffness),
                    1e-9 * coupling.stiffness)
            << rate << " " << delay << " " << damping;
        within = within || stiffness == held;
      }
  EXPECT_TRUE(within);
}

// The smallest painted damping is the scene's own; the largest may buzz by itself.
TEST(Stabilisers, PredictTheWorseOfMinAndMaxDamping) {
  HapticProperties haptics;
  const DeviceModel device;
  for (const double most : {1., 20., 150., 1000.}) {
    HapticProperties damped = haptics;
    damped.damping = most;
    const auto limit = [&](const HapticProperties& of) {
      return planStabilisers(of, device, std::nullopt).predicted_limit.value();
    };
    EXPECT_EQ(planStabilisers(haptics, device, std::nullopt, most).predicted_limit.value(),
              std::min(limit(haptics), limit(damped)))
        << most;
  }
}

} // namespace
} // namespace patina
