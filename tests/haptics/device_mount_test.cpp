#include "haptics/device/device_mount.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patina {
namespace {

constexpr double kDyadicPeriod = 0x1p-10;

// Plays the states that the test sets, and keeps the forces that it received.
struct Script {
  DeviceState state;
  Vec3 force = Vec3::Zero();
};
class ScriptedDevice final : public Device {
 public:
  explicit ScriptedDevice(Script& script) : script_(script) {}
  DeviceState exchange(const Vec3& force, double) noexcept override {
    script_.force = force;
    return script_.state;
  }

 private:
  Script& script_;
};

struct Mounted {
  explicit Mounted(const MountSpec& spec = {})
      : device(mountDevice(std::make_unique<ScriptedDevice>(script), spec, controls)) {}
  Vec3 tip(const Vec3& hand, const Vec3& force = Vec3::Zero()) {
    script.state.position = hand;
    return device->exchange(force, kDyadicPeriod).position;
  }
  Script script;
  std::shared_ptr<MountControls> controls = std::make_shared<MountControls>();
  std::unique_ptr<Device> device;
};

// 90 degrees about z: x becomes y, without rounding.
MountSpec turned(double scale) {
  MountSpec spec;
  spec.world_from_device.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  spec.world_from_device.translation() = Vec3(0.5, 0.25, -0.125);
  spec.scale = scale;
  return spec;
}

TEST(DeviceMount, ChangesNoBitIfNeutral) {
  Mounted mounted;
  mounted.script.state.velocity = Vec3(0.1, 0.2, 0.3);
  mounted.script.state.orientation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
  mounted.script.state.buttons = 5;
  const Vec3 hand(0.1, -0.7, 1e-7), force(0.3, -1e-9, 17);
  EXPECT_EQ(mounted.tip(hand, force), hand);
  EXPECT_EQ(mounted.script.force, force);
  const DeviceState state = mounted.device->exchange(force, kDyadicPeriod);
  EXPECT_EQ(*state.velocity, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(state.orientation.coeffs(), mounted.script.state.orientation.coeffs());
  EXPECT_EQ(state.buttons, 5u);
}

TEST(DeviceMount, TurnsScalesAndPlacesTheTip) {
  Mounted mounted(turned(4));
  mounted.script.state.velocity = Vec3(1, 0, 2);
  EXPECT_EQ(mounted.tip(Vec3(1, 2, 3)), Vec3(0.5 - 8, 0.25 + 4, -0.125 + 12));
  const DeviceState state = mounted.device->exchange(Vec3::Zero(), kDyadicPeriod);
  EXPECT_EQ(*state.velocity, Vec3(0, 4, 8));
  EXPECT_LT((state.orientation * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
}

// F_d v_d = F v: a surface gives no extra energy through a mount.
TEST(DeviceMount, ConservesPowerAtEveryScale) {
  for (const double scale : {0.125, 1.0, 8.0}) {
    MountSpec spec = turned(scale);
    spec.world_from_device.rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    Mounted mounted(spec);
    const Vec3 from(0.01, 0.02, -0.01), moved(1e-3, -2e-3, 5e-4), force(0.4, -0.3, 1.1);
    const Vec3 before = mounted.tip(from, force);
    const Vec3 after = mounted.tip(from + moved, force);
    EXPECT_NEAR(mounted.script.force.dot(moved), force.dot(after - before), 1e-15) << scale;
    EXPECT_NEAR(mounted.script.force.norm(), scale * force.norm(), 1e-14) << scale;
  }
}

TEST(DeviceMount, SendsNoMoreThanTheDeviceRendersInTheSameDirection) {
  MountSpec spec = turned(2);
  spec.max_force = 5;
  Mounted mounted(spec);
  mounted.tip(Vec3::Zero(), Vec3(0, 30, 40)); // 100 N at the device
  EXPECT_LE(mounted.script.force.norm(), 5);
  EXPECT_LT((mounted.script.force - Vec3(3, 0, 4)).norm(), 1e-13);
}

TEST(DeviceMount, HoldsTheTipUnderAClutchAndContinuesWithoutAJump) {
  Mounted mounted(turned(4));
  const Vec3 held = mounted.tip(Vec3(0.01, 0, 0));
  mounted.controls->clutched = true;
  EXPECT_EQ(mounted.tip(Vec3(0.01, 0, 0)), held);
  mounted.script.state.velocity = Vec3(1, 1, 1);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(mounted.tip(Vec3(0.01 + 0.001 * i, 0.3, -0.002 * i)), held);
    EXPECT_EQ(*mounted.device->exchange(Vec3::Zero(), kDyadicPeriod).velocity, Vec3::Zero());
  }
  mounted.controls->clutched = false;
  const Vec3 hand(0.25, 0.5, 0.75);
  EXPECT_EQ(mounted.tip(hand), held) << "the tick of the release";
  EXPECT_LT((mounted.tip(hand) - held).norm(), 1e-15);
  EXPECT_LT((mounted.tip(hand + Vec3(0, 0, 0.01)) - held - Vec3(0, 0, 0.04)).norm(), 1e-15);
}

TEST(DeviceMount, ButtonIsAClutchWhileDown) {
  MountSpec spec;
  spec.clutch_button = 2;
  Mounted mounted(spec);
  mounted.script.state.buttons = 0b011; // others
  EXPECT_EQ(mounted.tip(Vec3(1, 0, 0)), Vec3(1, 0, 0));
  EXPECT_EQ(mounted.tip(Vec3(2, 0, 0)), Vec3(2, 0, 0));
  mounted.script.state.buttons = 0b100;
  EXPECT_EQ(mounted.tip(Vec3(3, 0, 0)), Vec3(3, 0, 0)) << "where the button was pressed";
  EXPECT_EQ(mounted.tip(Vec3(4, 0, 0), Vec3(1, 1, 1)), Vec3(3, 0, 0));
  EXPECT_EQ(mounted.script.force, Vec3::Zero());
  mounted.script.state.buttons = 0;
  EXPECT_EQ(mounted.tip(Vec3(5, 0, 0)), Vec3(3, 0, 0));
  EXPECT_EQ(mounted.tip(Vec3(6, 0, 0)), Vec3(4, 0, 0));
}

// The force rises evenly from zero over kMountFadeTime: in contact it would step.
TEST(DeviceMount, SendsNoForceUnlessEnabledAndUnclutchedAndRampsItBack) {
  for (std::atomic<bool> MountControls::*control :
       {&MountControls::enabled, &MountControls::clutched}) {
    const bool rests = control == &MountControls::clutched;
    Mounted mounted;
    const Vec3 force(0, 0, 2);
    (*mounted.controls).*control = rests;
    for (int i = 0; i < 10; ++i) {
      mounted.tip(Vec3::Zero(), force);
      EXPECT_EQ(mounted.script.force, Vec3::Zero());
    }
    (*mounted.controls).*control = !rests;
    if (rests) mounted.tip(Vec3::Zero(), force); // the last reading still holds it
    for (int i = 1; i < 200; ++i) {
      mounted.tip(Vec3::Zero(), force);
      EXPECT_NEAR(mounted.script.force.z(), 2 * std::min(1.0, i * kDyadicPeriod / kMountFadeTime),
                  1e-12);
    }
  }
}

TEST(DeviceMount, TipFollowsWithoutEnable) {
  Mounted mounted(turned(1));
  mounted.controls->enabled = false;
  EXPECT_EQ(mounted.tip(Vec3(1, 0, 0)), Vec3(0.5, 1.25, -0.125));
}

TEST(DeviceMount, PassesAFailureOnAndRecovers) {
  Mounted mounted(turned(4));
  const Vec3 held = mounted.tip(Vec3(0.01, 0, 0));
  mounted.controls->clutched = true;
  mounted.tip(Vec3(0.01, 0, 0));
  mounted.tip(Vec3::Constant(std::nan("")));
  mounted.script.state.status = DeviceStatus::calibrating;
  mounted.script.state.position = Vec3(9, 9, 9);
  EXPECT_EQ(mounted.device->exchange(Vec3::Zero(), kDyadicPeriod).status,
            DeviceStatus::calibrating);
  mounted.script.state.status = DeviceStatus::ok;
  mounted.controls->clutched = false;
  EXPECT_EQ(mounted.tip(Vec3(0.02, 0, 0)), held);
}

TEST(DeviceMount, RefusesInvalidMounts) {
  EXPECT_THROW(Mounted(turned(0)), std::invalid_argument);
  EXPECT_THROW(Mounted(turned(std::nan(""))), std::invalid_argument);
  MountSpec spec;
  spec.max_force = 0;
  EXPECT_THROW(Mounted{spec}, std::invalid_argument);
  spec = {};
  spec.world_from_device.linear() *= 2;
  EXPECT_THROW(Mounted{spec}, std::invalid_argument);
  EXPECT_THROW(mountDevice(nullptr, {}, std::make_shared<MountControls>()), std::invalid_argument);
}

} // namespace
} // namespace patina
