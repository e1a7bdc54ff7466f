// The SpaceMouse's reports and the tip that it moves, against the emulated device.
#include "haptics/spacemouse/emulated_spacemouse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "haptics/link/link_loop.h"
#include "support/scripted_transport.h"

namespace patina::test {
namespace {

TEST(SpaceMouseReport, BothFormsGiveTheSameValues) {
  // X 256, Y -2, Z 5 and Rx 1, Ry 0, Rz -256, little end first.
  const Bytes shift = bytes({1, 0, 1, 0xfe, 0xff, 5, 0});
  const Bytes turn = bytes({2, 1, 0, 0, 0, 0, 0xff});
  Bytes both = shift;
  both.insert(both.end(), turn.begin() + 1, turn.end());
  CapState one, two;
  EXPECT_TRUE(takeReport(both, one));
  EXPECT_TRUE(takeReport(shift, two));
  EXPECT_EQ(two.rotation, Vec3::Zero());
  EXPECT_TRUE(takeReport(turn, two));
  for (const CapState& cap : {one, two}) {
    EXPECT_EQ(cap.translation, Vec3(256, -5, -2)); // the device's y points to the user, its z down
    EXPECT_EQ(cap.rotation, Vec3(1, 256, 0));
  }
}

TEST(SpaceMouseReport, ButtonsHaveReportsOfTheirOwn) {
  CapState cap;
  EXPECT_TRUE(takeReport(bytes({3, 0x05, 0x80}), cap));
  EXPECT_EQ(cap.buttons, 0x8005U);
  EXPECT_TRUE(takeReport(bytes({3, 0}), cap));
  EXPECT_EQ(cap.buttons, 0U);
}

TEST(SpaceMouseReport, InvalidReportChangesNothing) {
  CapState cap;
  ASSERT_TRUE(takeReport(bytes({1, 9, 0, 9, 0, 9, 0}), cap));
  const Vec3 before = cap.translation;
  for (const Bytes& none : {bytes({}), bytes({1}), bytes({1, 2, 3, 4, 5, 6}),
                            bytes({1, 1, 1, 1, 1, 1, 1, 1}), bytes({2, 1, 1, 1}), bytes({3}),
                            bytes({0, 1, 1, 1, 1, 1, 1}), bytes({23, 1, 1, 1, 1, 1, 1})}) {
    EXPECT_FALSE(takeReport(none, cap));
    EXPECT_EQ(cap.translation, before);
  }
}

TEST(SpaceMouseReport, AnyBytesGiveBoundedFiniteCounts) {
  std::mt19937 random(1);
  CapState cap;
  for (int i = 0; i < 300000; ++i) {
    Bytes report(random() % 20);
    for (std::byte& b : report) b = static_cast<std::byte>(random() & 255U);
    if (!report.empty()) report[0] = static_cast<std::byte>(random() % 5);
    takeReport(report, cap);
    ASSERT_LE(cap.translation.lpNorm<Eigen::Infinity>(), 500);
    ASSERT_LE(cap.rotation.lpNorm<Eigen::Infinity>(), 500);
  }
}

struct CapRig {
  explicit CapRig(bool two_reports)
      : clock(std::make_shared<SimulatedClock>()), cap(std::make_shared<EmulatedCap>()),
        notes(std::make_shared<LinkStatistics>()) {
    cap->two_reports = two_reports;
    cap->hand = [this](double t) { return t < until ? pushed : CapState{}; };
  }
  void start(const SpaceMouseSpec& spec = {}) {
    loop.emplace(makeSpaceMouseLink([this] { return emulateSpaceMouse(cap, clock); }, spec, clock),
                 GuardSpec{}, clock, notes);
  }
  DeviceState run(double seconds) {
    DeviceState state;
    for (const double end = clock->now() + seconds; clock->now() < end;) {
      const double next = clock->now() + 1e-3;
      state = loop->step({Vec3(1, 2, 3), clock->now()});
      clock->waitUntil(next);
    }
    return state;
  }
  std::shared_ptr<SimulatedClock> clock;
  std::shared_ptr<EmulatedCap> cap;
  std::shared_ptr<LinkStatistics> notes;
  CapState pushed;
  double until = 1e9;
  std::optional<LinkLoop> loop;
};

TEST(SpaceMouse, TipFollowsTheCapsPushAndStopsOnRelease) {
  for (const bool two_reports : {false, true}) {
    CapRig rig(two_reports);
    rig.pushed.translation = Vec3(kSpaceMouseFull, -kSpaceMouseFull, 0);
    rig.until = 2;
    rig.start({.start = Vec3(1, 2, 3), .speed = 0.1});
    const DeviceState at_one = rig.run(1);
    EXPECT_EQ(at_one.status, DeviceStatus::ok);
    const Vec3 one = at_one.position;
    ASSERT_TRUE(at_one.velocity.has_value());
    EXPECT_LT((*at_one.velocity - Vec3(0.1, -0.1, 0)).norm(), 1e-12);
    EXPECT_LT((one - Vec3(1.1, 1.9, 3)).norm(), 0.005); // one report late
    const Vec3 two = rig.run(1.5).position;
    EXPECT_LT((two - Vec3(1.2, 1.8, 3)).norm(), 0.005);
    EXPECT_EQ(rig.run(1).position, two);
    EXPECT_EQ(rig.notes->faults, 0U) << "a cap at rest is silent, not lost";
  }
}

TEST(SpaceMouse, TurnsTheTipAboutTheAxisOfTheCap) {
  CapRig rig(true);
  rig.pushed.rotation = Vec3(0, kSpaceMouseFull, 0);
  rig.start({.turn_speed = 1});
  const Eigen::AngleAxisd turned(rig.run(1).orientation);
  EXPECT_NEAR(turned.angle(), 1, 0.03);
  EXPECT_LT((turned.axis() - Vec3::UnitY()).norm(), 1e-9);
}

TEST(SpaceMouse, TipStopsIfThePushedCapIsUnpluggedAndReturns) {
  CapRig rig(false);
  rig.pushed.translation = Vec3(0, 0, kSpaceMouseFull);
  rig.start();
  const Vec3 before = rig.run(0.5).position;
  rig.cap->attached = false;
  EXPECT_EQ(rig.run(1).status, DeviceStatus::reconnecting);
  EXPECT_EQ(rig.notes->cause(), "the emulated SpaceMouse is not attached");
  rig.cap->attached = true;
  rig.until = 0; // released
  const DeviceState after = rig.run(1);
  EXPECT_EQ(after.status, DeviceStatus::ok);
  EXPECT_LT((after.position - before).norm(), 3e-3);
}

} // namespace
} // namespace patina::test
