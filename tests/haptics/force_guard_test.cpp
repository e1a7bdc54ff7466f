// What the guard lets through, and when: held against closed forms.
#include "haptics/devices/link/force_guard.h"
#include "support/constants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace patina {
namespace {

using test::kPeriod;

DeviceState at(const Vec3& place, std::uint32_t buttons = 0) {
  DeviceState state{place};
  state.buttons = buttons;
  return state;
}

// A guard whose ramp is over.
ForceGuard opened(const GuardSpec& spec, const DeviceState& state = at(Vec3::Zero())) {
  ForceGuard guard(spec);
  for (int i = 0; i < 300; ++i) guard.pass({}, state, kPeriod);
  EXPECT_EQ(guard.gain(), 1);
  return guard;
}

TEST(ForceGuard, EachFaultTakesTheForceAtOnceAndItComesBackEvenlyOverTheRamp) {
  const GuardSpec spec;
  const DeviceState good = at(Vec3::Zero(), 1U << 2);
  const Vec3 force(1, -2, 0.5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    Hold hold;
    ForceGuard::Asked asked;
    DeviceState state;
  };
  DeviceState silent = good, garbled = good, away = good, old = good, homing = good;
  silent.status = DeviceStatus::silent;
  garbled.status = DeviceStatus::garbled;
  away.status = DeviceStatus::away;
  homing.status = DeviceStatus::calibrating;
  old.age = 1.01 * kOldestAge;
  for (const Case& fault :
       {Case{Hold::device, {force}, silent}, Case{Hold::device, {force}, garbled},
        Case{Hold::device, {force}, away}, Case{Hold::device, {force}, old},
        Case{Hold::device, {force}, homing}, Case{Hold::device, {force}, at(Vec3(0, nan, 0), 4)},
        Case{Hold::servo, {force, 1.01 * spec.oldest_command}, good},
        Case{Hold::servo, {force, nan}, good},
        Case{Hold::window, {force, 0, 1.01 * spec.oldest_look}, good},
        Case{Hold::command, {Vec3(nan, 0, 0)}, good},
        Case{Hold::command, {Vec3(0, 0, HUGE_VAL)}, good},
        Case{Hold::let_go, {force, 0, 0, true}, at(Vec3::Zero())}}) {
    ForceGuard guard = opened(spec, good);
    EXPECT_EQ(guard.pass({force, 0, 0, true}, good, kPeriod), force);
    EXPECT_EQ(guard.pass(fault.asked, fault.state, kPeriod), Vec3::Zero()) << text(fault.hold);
    EXPECT_EQ(guard.hold(), fault.hold);
    for (int i = 1; i <= 250; ++i) {
      const Vec3 sent = guard.pass({force}, good, kPeriod);
      ASSERT_LT((sent - i / 250.0 * force).norm(), 1e-12) << i;
    }
    EXPECT_EQ(guard.hold(), Hold::none);
  }
}

TEST(ForceGuard, ALateTurnDoesNotCutTheRampShort) {
  ForceGuard guard({});
  const Vec3 force(1, 0, 0);
  EXPECT_LE(guard.pass({force}, at(Vec3::Zero()), 10).norm(), 0.01 / 0.25 + 1e-12);
}

TEST(ForceGuard, NoForcePushesOutOfTheWorkspaceButEveryForcePullsBack) {
  const GuardSpec spec{.workspace = Box3(Vec3::Constant(-0.05), Vec3::Constant(0.05))};
  ForceGuard guard = opened(spec);
  for (const double side : {-1.0, 1.0}) {
    const auto sent = [&](double over, double push) {
      return guard.pass({Vec3(side * push, 2, 0)}, at(Vec3(side * (0.05 + over), 0, 0)), kPeriod);
    };
    EXPECT_EQ(sent(-1e-3, 1), Vec3(side, 2, 0));
    EXPECT_LT((sent(1e-3, 1) - Vec3(0.5 * side, 2, 0)).norm(), 1e-9); // half of the edge's 2 mm
    EXPECT_LT((sent(3e-3, 1) - Vec3(0, 2, 0)).norm(), 1e-12);
    EXPECT_EQ(sent(3e-3, -1), Vec3(-side, 2, 0));
  }
}

TEST(ForceGuard, TheHandlesWeightIsBorneAndCountsForTheLimit) {
  ForceGuard guard = opened({.max_force = 2, .weight = Vec3(0, 1, 0)});
  EXPECT_EQ(guard.pass({Vec3(0.5, 0, 0)}, at(Vec3::Zero()), kPeriod), Vec3(0.5, 1, 0));
  EXPECT_NEAR(guard.pass({Vec3(0, 9, 0)}, at(Vec3::Zero()), kPeriod).norm(), 2, 1e-12);
  DeviceState away;
  away.status = DeviceStatus::away;
  EXPECT_EQ(guard.pass({}, away, kPeriod), Vec3::Zero());
}

// dh/dt = ((F/c)^2 - h) / T under a constant force has h = (F/c)^2 (1 - exp(-t/T)).
TEST(ForceGuard, MotorsWarmAsTheirModelSays) {
  const GuardSpec spec{.max_force = 3, .motors = {.continuous = 3, .time_constant = 5}};
  ForceGuard guard = opened(spec);
  const double load = 2.0 / 3;
  for (int i = 1; i <= 4000; ++i) {
    guard.pass({Vec3(0, 2, 0)}, at(Vec3::Zero()), kPeriod);
    ASSERT_NEAR(guard.heat(), load * load * (1 - std::exp(-i * kPeriod / 5)), 1e-9);
  }
}

TEST(ForceGuard, HotMotorsGetLessSmoothlyAndNeverPassTheirHeat) {
  const GuardSpec spec{.max_force = 6, .motors = {.continuous = 3, .time_constant = 2}};
  ForceGuard guard = opened(spec);
  double before = 6;
  for (int i = 0; i < 60000; ++i) { // an hour's worth of time constants
    const double sent = guard.pass({Vec3(0, 0, -50)}, at(Vec3::Zero()), kPeriod).norm();
    ASSERT_LE(guard.heat(), 1);
    ASSERT_LE(sent, before + 1e-9);      // ever less
    ASSERT_GE(sent, before - 0.05) << i; // and no step that is felt
    before = sent;
  }
  EXPECT_NEAR(before, 3, 0.05);
  for (int i = 0; i < 10000; ++i) guard.pass({}, at(Vec3::Zero()), kPeriod);
  EXPECT_LT(guard.heat(), 0.01); // rested, it has all of it again
  EXPECT_NEAR(guard.pass({Vec3(0, 0, -50)}, at(Vec3::Zero()), kPeriod).norm(), 6, 1e-9);
}

TEST(ForceGuard, RefusesWhatIsNoGuard) {
  EXPECT_THROW(ForceGuard({.max_force = 0}), std::invalid_argument);
  EXPECT_THROW(ForceGuard({.motors = {.continuous = -1}}), std::invalid_argument);
  EXPECT_THROW(ForceGuard({.ramp = 0}), std::invalid_argument);
  EXPECT_THROW(ForceGuard({.oldest_command = std::nan("")}), std::invalid_argument);
}

} // namespace
} // namespace patina
