// The built-in devices: a target that a pointer moves, the mouse's tip, the simulated and the
// replayed hand, and their catalog.
#include "haptics/catalog/device_catalog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "core/error.h"
#include "haptics/simulation/simulated_hand.h"
#include "support/constants.h"

namespace patina {
namespace {

using test::kNan;
using test::kPeriod;

std::shared_ptr<TipTarget> targetAt(const Vec3& place) {
  return std::make_shared<TipTarget>(place);
}

TEST(Mouse, NeverMovesFasterThanItsLimitAndArrives) {
  const auto target = targetAt(Vec3::Zero());
  const auto mouse = makeMouse(target, 0.5);
  target->set(Vec3(0.05, 0, 0));
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < 400; ++i) {
    const Vec3 tip = mouse->exchange(Vec3::Zero(), kPeriod).position;
    EXPECT_LE((tip - last).norm(), 0.5 * kPeriod * (1 + 1e-12));
    last = tip;
  }
  EXPECT_NEAR(last.x(), 0.05, 1e-6);
}

TEST(TipTarget, IgnoresNonFiniteTargets) {
  const auto target = targetAt(Vec3(0, 0, 0.01));
  target->set(Vec3(kNan, 0, 0));
  EXPECT_EQ(makeMouse(target)->exchange(Vec3::Zero(), kPeriod).position, Vec3(0, 0, 0.01));
  EXPECT_THROW(TipTarget(Vec3(kNan, 0, 0)), std::invalid_argument);
}

TEST(TipTarget, IsNeverReadHalfWritten) {
  // Every target lies on the diagonal; a torn read would leave it.
  const auto target = targetAt(Vec3::Zero());
  const auto mouse = makeMouse(target, 1e9);
  std::thread writer([&] {
    for (int i = 1; i <= 20000; ++i) target->set(Vec3::Constant(i));
  });
  for (int i = 0; i < 20000; ++i) {
    const Vec3 tip = mouse->exchange(Vec3::Zero(), kPeriod).position;
    ASSERT_EQ(tip.x(), tip.y());
    ASSERT_EQ(tip.x(), tip.z());
  }
  writer.join();
}

// A hand-drawn zigzag, a position every 8 ms.
std::vector<TipTarget::Waypoint> zigzag() {
  std::vector<TipTarget::Waypoint> places;
  for (int i = 0; i <= 60; ++i)
    places.push_back({Vec3(1e-3 * i, 1e-3 * std::abs(i % 20 - 10), 0), 3 + 0.008 * i, 0});
  return places;
}

// Returns the tip's path if each waypoint arrives at the time that the function gives.
std::vector<Vec3> followed(const std::function<double(double)>& told) {
  const auto target = targetAt(Vec3(0, 0.01, 0));
  const auto mouse = makeMouse(target);
  const auto places = zigzag();
  std::vector<Vec3> way;
  std::size_t next = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    while (next < places.size() && told(places[next].t) <= 3 + tick * kPeriod) {
      target->addWaypoint(places[next].world, places[next].t);
      ++next;
    }
    way.push_back(mouse->exchange(Vec3::Zero(), kPeriod).position);
    if (next == places.size() && target->allReached()) return way;
  }
  ADD_FAILURE() << "it never arrives";
  return way;
}

TEST(TipTarget, FollowsEveryWaypointHoweverLateItArrives) {
  const auto late = [](double t) { return 3 + 0.25 * std::ceil((t - 3) / 0.25); };
  for (const auto& way : {followed([](double t) { return t; }), followed(late)}) {
    for (const auto& place : zigzag()) {
      double nearest = 1;
      for (const Vec3& tip : way) nearest = std::min(nearest, (tip - place.world).norm());
      EXPECT_LT(nearest, 1.5e-4) << place.world.transpose(); // half of a tick's distance
    }
    for (std::size_t i = 1; i < way.size(); ++i) // the hand does 0.18 m/s
      EXPECT_LT((way[i] - way[i - 1]).norm(), 2.5 * 0.18 * kPeriod) << i;
  }
}

TEST(TipTarget, PathTakesTheHandsTimeAndKeepsRests) {
  const auto target = targetAt(Vec3::Zero());
  const auto mouse = makeMouse(target);
  target->addWaypoint(Vec3(0.001, 0, 0), 1.0);
  target->addWaypoint(Vec3(0.002, 0, 0), 1.3);
  target->addWaypoint(Vec3(0.003, 0, 0), 1.31);
  int ticks = 0, rest = 0;
  for (; ticks < 2000 && !target->allReached(); ++ticks)
    if (mouse->exchange(Vec3::Zero(), kPeriod).position.x() == 0.001) ++rest;
  EXPECT_NEAR(ticks, 330, 5); // a step to the first position, then the hand's time
  EXPECT_NEAR(rest, 280, 5);
}

// 50 mm in a step of the pointer: a hand of 1/4 m/s takes 200 ms for them.
TEST(TipTarget, LegTakesTheTimeOfItsSpeedLimit) {
  const auto target = targetAt(Vec3::Zero());
  const auto mouse = makeMouse(target, 0.25);
  target->addWaypoint(Vec3(0.05, 0, 0), 1.0);
  Vec3 last = Vec3::Zero();
  int ticks = 0;
  for (; ticks < 1000 && !target->allReached(); ++ticks) {
    const Vec3 tip = mouse->exchange(Vec3::Zero(), kPeriod).position;
    ASSERT_LE((tip - last).norm(), 1.0001 * 0.25 * kPeriod);
    last = tip;
  }
  EXPECT_NEAR(ticks, 200, 2);
}

TEST(TipTarget, SetTargetDropsThePath) {
  const auto target = targetAt(Vec3::Zero());
  const auto mouse = makeMouse(target);
  for (int i = 1; i < 50; ++i) target->addWaypoint(Vec3(0, 1e-3 * i, 0), 0.01 * i);
  mouse->exchange(Vec3::Zero(), kPeriod);
  EXPECT_FALSE(target->allReached());
  target->set(Vec3(0.01, 0, 0));
  Vec3 tip;
  for (int i = 0; i < 500; ++i) tip = mouse->exchange(Vec3::Zero(), kPeriod).position;
  EXPECT_TRUE(target->allReached());
  EXPECT_NEAR((tip - Vec3(0.01, 0, 0)).norm(), 0, 1e-6);
}

// The tip jumps from one side of a ball to the other: nothing between is touched, and the waypoint
// before the jump is still passed.
TEST(TipTarget, JumpMakesNoContactOnItsPath) {
  const auto target = targetAt(Vec3(0.03, 0, 0));
  const auto mouse = makeMouse(target);
  target->addWaypoint(Vec3(0.03, 0.001, 0), 1);
  target->jumpTo(Vec3(-0.03, 0, 0), 1.02);
  target->addWaypoint(Vec3(-0.02, 0, 0), 1.02);
  int lifted = 0, passed = 0;
  for (int tick = 0; tick < 1000 && !target->allReached(); ++tick) {
    const DeviceState state = mouse->exchange(Vec3::Zero(), kPeriod);
    if (state.position == Vec3(0.03, 0.001, 0)) ++passed;
    if (state.status == DeviceStatus::repositioning) {
      ++lifted;
      continue;
    }
    EXPECT_EQ(state.status, DeviceStatus::ok);
    EXPECT_GE(std::abs(state.position.x()), 0.02);
    EXPECT_TRUE(lifted || state.position.x() > 0);
  }
  EXPECT_NEAR(lifted, kJumpTime / kPeriod, 1);
  EXPECT_GE(passed, 1);
  EXPECT_EQ(mouse->exchange(Vec3::Zero(), kPeriod).position, Vec3(-0.02, 0, 0));
}

// A pointer hovers, so that its times were not read, and then presses.
TEST(TipTarget, JumpIsAppliedAtOnce) {
  const auto target = targetAt(Vec3::Zero());
  const auto mouse = makeMouse(target);
  const auto goesTo = [&](const Vec3& place, int ticks) {
    DeviceState state;
    for (int tick = 0; tick < ticks; ++tick) state = mouse->exchange(Vec3::Zero(), kPeriod);
    return state.position == place && target->allReached();
  };
  target->jumpTo(Vec3(0.01, 0, 0), 0);
  EXPECT_TRUE(goesTo(Vec3(0.01, 0, 0), 100));
  target->jumpTo(Vec3(0.02, 0, 0), 1000);
  target->addWaypoint(Vec3(0.021, 0, 0), 1000);
  target->addWaypoint(Vec3(0.022, 0, 0), 1000.01);
  EXPECT_TRUE(goesTo(Vec3(0.022, 0, 0), 100));
}

TEST(TipTarget, BodyWithMassGlidesWhereAMouseJumps) {
  const auto target = targetAt(Vec3::Zero());
  const auto hand = makeSimulatedHand(target);
  target->jumpTo(Vec3(0.05, 0, 0), 1);
  Vec3 before = Vec3::Zero();
  for (int tick = 0; tick < 300; ++tick) {
    const DeviceState state = hand->exchange(Vec3::Zero(), kPeriod);
    EXPECT_EQ(state.status, DeviceStatus::ok);
    EXPECT_LT((state.position - before).norm(), 2e-3);
    before = state.position;
  }
  EXPECT_NEAR(before.x(), 0.05, 0.01);
}

struct Held {
  std::shared_ptr<TipTarget> target = targetAt(Vec3::Zero());
  std::unique_ptr<Device> hand;
  explicit Held(const HandSpec& spec = {}) : hand(makeSimulatedHand(target, spec)) {}
  Vec3 after(int ticks, const Vec3& force) {
    Vec3 tip = Vec3::Zero();
    for (int i = 0; i < ticks; ++i) tip = hand->exchange(force, kPeriod).position;
    return tip;
  }
};

TEST(SimulatedHand, RestsWhereItsSpringBalancesTheForce) {
  const Vec3 force(0.5, -1, 0.25), place(0.01, 0, 0.02);
  Held held;
  held.target->set(place);
  EXPECT_LT((held.after(3000, force) - (place + force / HandSpec{}.stiffness)).norm(), 1e-9);
}

TEST(SimulatedHand, NeverPullsHarderThanItsLimit) {
  Held held;
  held.target->set(Vec3(1, 0, 0));
  // A wall holds the hand still and yields to more than the hand's largest force.
  for (int tick = 0; tick < 2000; ++tick)
    ASSERT_LT(held.after(1, Vec3(-1.001 * HandSpec{}.max_force, 0, 0)).x(), 1e-9);
}

TEST(SimulatedHand, ForceArrivesAfterTheModelsDelay) {
  Held held({.device = {.delay = 3}});
  for (int tick = 0; tick < 3; ++tick)
    EXPECT_EQ(held.after(1, Vec3(1, 0, 0)), Vec3::Zero()) << tick;
  EXPECT_GT(held.after(1, Vec3(1, 0, 0)).x(), 0);
}

TEST(SimulatedHand, IsReadInWholeStepsOfItsEncoder) {
  constexpr double kStep = 50e-6;
  Held held({.device = {.encoder_step = kStep}});
  held.target->set(Vec3(0.01, -0.004, 0));
  for (int tick = 0; tick < 500; ++tick) {
    const Vec3 counts = held.after(1, Vec3::Zero()) / kStep;
    ASSERT_LT((counts - counts.array().round().matrix()).norm(), 1e-9);
  }
}

TEST(SimulatedHand, DryFrictionHoldsEachAxisUpToItsForce) {
  constexpr double kFriction = 0.4;
  Held held({.device = {.coulomb = kFriction}});
  EXPECT_EQ(held.after(200, Vec3(0.39, -0.39, 0.2)), Vec3::Zero());
  // Past it the tip goes to where the hand's spring balances the rest.
  const Vec3 tip = Held({.device = {.coulomb = kFriction}}).after(3000, Vec3(1, 0.3, 0));
  EXPECT_NEAR(tip.x(), (1 - kFriction) / HandSpec{}.stiffness, 1e-6);
  EXPECT_EQ(tip.y(), 0);
}

TEST(SimulatedHand, RefusesInvalidDevices) {
  EXPECT_THROW(Held({.device = {.delay = -1}}), std::invalid_argument);
  EXPECT_THROW(Held({.device = {.delay = kMaxDelay + 1}}), std::invalid_argument);
  EXPECT_THROW(Held({.device = {.mass = 0}}), std::invalid_argument);
  EXPECT_THROW(makeSimulatedHand(nullptr), std::invalid_argument);
}

TEST(ReplayedHand, MovesStraightBetweenRowsAndRestsAtTheLast) {
  const auto hand = makeReplayedHand(
      {{5, Vec3(0, 0, 0)}, {5.25, Vec3(1, 0, 0)}, {5.5, Vec3(1, 2, 0)}, {6, Vec3(1, 2, 4)}});
  const Vec3 force(1, 2, 3); // any force
  EXPECT_EQ(hand->exchange(force, 0).position, Vec3(0, 0, 0));
  EXPECT_EQ(hand->exchange(force, 0.125).position, Vec3(0.5, 0, 0));
  EXPECT_EQ(hand->exchange(force, 0.25).position, Vec3(1, 1, 0));
  EXPECT_EQ(hand->exchange(force, 0.375).position, Vec3(1, 2, 2));
  for (int tick = 0; tick < 3; ++tick)
    EXPECT_EQ(hand->exchange(force, 0.25).position, Vec3(1, 2, 4));
}

TEST(ReplayedHand, RefusesInvalidPaths) {
  EXPECT_THROW(makeReplayedHand({}), std::invalid_argument);
  EXPECT_THROW(makeReplayedHand({{0, Vec3::Zero()}, {0, Vec3::Zero()}}), std::invalid_argument);
  EXPECT_THROW(makeReplayedHand({{0, Vec3(0, kNan, 0)}}), std::invalid_argument);
}

TEST(DeviceState, IsJudgedByItsStatusAndThenByItsAge) {
  const auto judged = [](DeviceStatus status, double age) {
    DeviceState state;
    state.status = status;
    state.age = age;
    return effectiveStatus(state);
  };
  EXPECT_EQ(judged(DeviceStatus::ok, 0), DeviceStatus::ok);
  EXPECT_EQ(judged(DeviceStatus::ok, kMaxStateAge), DeviceStatus::ok);
  EXPECT_EQ(judged(DeviceStatus::ok, 1.01 * kMaxStateAge), DeviceStatus::timed_out);
  EXPECT_EQ(judged(DeviceStatus::ok, kNan), DeviceStatus::timed_out);
  EXPECT_EQ(judged(DeviceStatus::gone, 1), DeviceStatus::gone);
}

TEST(DeviceCatalog, OpensEachOfItsDevicesAtItsStart) {
  const Vec3 start(0.01, 0.02, 0.03);
  for (const DeviceEntry& entry : deviceCatalog()) {
    if (!entry.usb.empty()) continue;
    const auto device =
        openDevice(entry, {.target = targetAt(start), .path = {{0, start}, {1, start}}},
                   mountAt(entry, start));
    DeviceState state = device->exchange(Vec3::Zero(), kPeriod);
    // An emulated device has to be opened first.
    for (int i = 0; i < 5000 && holds(state.status); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      state = device->exchange(Vec3::Zero(), kPeriod);
    }
    const double counts = entry.limits.workspace ? 1e-4 : 0; // resolution of its encoders
    EXPECT_LE((state.position - start).norm(), counts) << entry.name;
    EXPECT_EQ(effectiveStatus(state), DeviceStatus::ok) << entry.name;
    EXPECT_NE(std::string(entry.note), "") << entry.name;
  }
}

TEST(DeviceCatalog, FindsSceneDevicesAndListsThemForAnUnknownName) {
  EXPECT_FALSE(deviceNamed("mouse").uses_device_model);
  EXPECT_TRUE(deviceNamed("simulated").uses_device_model);
  for (const char* name : {"telephone", "replay", ""}) {
    try {
      (void)deviceNamed(name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_TRUE(
          std::string(error.what())
              .starts_with("device = " + std::string(name) +
                           ": it must be mouse or simulated or falcon or spacemouse or sim:falcon"))
          << error.what();
    }
  }
}

} // namespace
} // namespace patina
