// Compares the guard's output and its times with closed forms.
#include "haptics/link/force_guard.h"
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

// Returns a guard whose ramp is over.
ForceGuard opened(const GuardSpec& spec, const DeviceState& state = at(Vec3::Zero())) {
  ForceGuard guard(spec);
  for (int i = 0; i < 300; ++i) guard.limit({}, state, kPeriod);
  EXPECT_EQ(guard.gain(), 1);
  return guard;
}

TEST(ForceGuard, RemovesTheForceAtOnceOnAFaultAndRampsItBack) {
  const GuardSpec spec;
  const DeviceState good = at(Vec3::Zero(), 1U << 2);
  const Vec3 force(1, -2, 0.5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    ForceInhibit hold;
    ForceGuard::ForceRequest asked;
    DeviceState state;
  };
  DeviceState silent = good, garbled = good, away = good, old = good, homing = good;
  silent.status = DeviceStatus::timed_out;
  garbled.status = DeviceStatus::protocol_error;
  away.status = DeviceStatus::reconnecting;
  homing.status = DeviceStatus::calibrating;
  old.age = 1.01 * kMaxStateAge;
  for (const Case& fault :
       {Case{ForceInhibit::device, {force}, silent}, Case{ForceInhibit::device, {force}, garbled},
        Case{ForceInhibit::device, {force}, away}, Case{ForceInhibit::device, {force}, old},
        Case{ForceInhibit::device, {force}, homing},
        Case{ForceInhibit::device, {force}, at(Vec3(0, nan, 0), 4)},
        Case{ForceInhibit::servo, {force, 1.01 * spec.max_command_age}, good},
        Case{ForceInhibit::servo, {force, nan}, good},
        Case{ForceInhibit::ui_timeout, {force, 0, 1.01 * spec.max_heartbeat_age}, good},
        Case{ForceInhibit::command, {Vec3(nan, 0, 0)}, good},
        Case{ForceInhibit::command, {Vec3(0, 0, HUGE_VAL)}, good},
        Case{ForceInhibit::deadman_released, {force, 0, 0, true}, at(Vec3::Zero())}}) {
    ForceGuard guard = opened(spec, good);
    EXPECT_EQ(guard.limit({force, 0, 0, true}, good, kPeriod), force);
    EXPECT_EQ(guard.limit(fault.asked, fault.state, kPeriod), Vec3::Zero()) << text(fault.hold);
    EXPECT_EQ(guard.inhibit(), fault.hold);
    for (int i = 1; i <= 250; ++i) {
      const Vec3 sent = guard.limit({force}, good, kPeriod);
      ASSERT_LT((sent - i / 250.0 * force).norm(), 1e-12) << i;
    }
    EXPECT_EQ(guard.inhibit(), ForceInhibit::none);
  }
}

TEST(ForceGuard, LateExchangeDoesNotShortenTheRamp) {
  ForceGuard guard({});
  const Vec3 force(1, 0, 0);
  EXPECT_LE(guard.limit({force}, at(Vec3::Zero()), 10).norm(), 0.01 / 0.25 + 1e-12);
}

TEST(ForceGuard, BlocksForcesOutOfTheWorkspaceAndPassesForcesBack) {
  const GuardSpec spec{.workspace = Box3(Vec3::Constant(-0.05), Vec3::Constant(0.05))};
  ForceGuard guard = opened(spec);
  for (const double side : {-1.0, 1.0}) {
    const auto sent = [&](double over, double push) {
      return guard.limit({Vec3(side * push, 2, 0)}, at(Vec3(side * (0.05 + over), 0, 0)), kPeriod);
    };
    EXPECT_EQ(sent(-1e-3, 1), Vec3(side, 2, 0));
    EXPECT_LT((sent(1e-3, 1) - Vec3(0.5 * side, 2, 0)).norm(), 1e-9); // half of the edge's 2 mm
    EXPECT_LT((sent(3e-3, 1) - Vec3(0, 2, 0)).norm(), 1e-12);
    EXPECT_EQ(sent(3e-3, -1), Vec3(-side, 2, 0));
  }
}

TEST(ForceGuard, CompensatesTheHandlesWeightWithinTheLimit) {
  ForceGuard guard = opened({.max_force = 2, .weight = Vec3(0, 1, 0)});
  EXPECT_EQ(guard.limit({Vec3(0.5, 0, 0)}, at(Vec3::Zero()), kPeriod), Vec3(0.5, 1, 0));
  EXPECT_NEAR(guard.limit({Vec3(0, 9, 0)}, at(Vec3::Zero()), kPeriod).norm(), 2, 1e-12);
  DeviceState away;
  away.status = DeviceStatus::reconnecting;
  EXPECT_EQ(guard.limit({}, away, kPeriod), Vec3::Zero());
}

// dh/dt = ((F/c)^2 - h) / T under a constant force has h = (F/c)^2 (1 - exp(-t/T)).
TEST(ForceGuard, MotorHeatFollowsItsModel) {
  const GuardSpec spec{.max_force = 3, .motors = {.continuous = 3, .time_constant = 5}};
  ForceGuard guard = opened(spec);
  const double load = 2.0 / 3;
  for (int i = 1; i <= 4000; ++i) {
    guard.limit({Vec3(0, 2, 0)}, at(Vec3::Zero()), kPeriod);
    ASSERT_NEAR(guard.heat(), load * load * (1 - std::exp(-i * kPeriod / 5)), 1e-9);
  }
}

TEST(ForceGuard, LimitsHotMotorsSmoothlyBelowTheirMaxHeat) {
  const GuardSpec spec{.max_force = 6, .motors = {.continuous = 3, .time_constant = 2}};
  ForceGuard guard = opened(spec);
  double before = 6;
  for (int i = 0; i < 60000; ++i) { // an hour of time constants
    const double sent = guard.limit({Vec3(0, 0, -50)}, at(Vec3::Zero()), kPeriod).norm();
    ASSERT_LE(guard.heat(), 1);
    ASSERT_LE(sent, before + 1e-9);      // decreasing
    ASSERT_GE(sent, before - 0.05) << i; // the step is too small to be felt
    before = sent;
  }
  EXPECT_NEAR(before, 3, 0.05);
  for (int i = 0; i < 10000; ++i) guard.limit({}, at(Vec3::Zero()), kPeriod);
  EXPECT_LT(guard.heat(), 0.01); // after a rest the whole force is available again
  EXPECT_NEAR(guard.limit({Vec3(0, 0, -50)}, at(Vec3::Zero()), kPeriod).norm(), 6, 1e-9);
}

TEST(ForceGuard, RefusesInvalidGuards) {
  EXPECT_THROW(ForceGuard({.max_force = 0}), std::invalid_argument);
  EXPECT_THROW(ForceGuard({.motors = {.continuous = -1}}), std::invalid_argument);
  EXPECT_THROW(ForceGuard({.ramp = 0}), std::invalid_argument);
  EXPECT_THROW(ForceGuard({.max_command_age = std::nan("")}), std::invalid_argument);
}

} // namespace
} // namespace patina
