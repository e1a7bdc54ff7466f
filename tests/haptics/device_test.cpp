#include "haptics/devices/device.h"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

namespace patina {
namespace {

constexpr double kPeriod = 1e-3;

TEST(MouseDevice, NeverMovesFasterThanItsLimitAndArrives) {
  const auto mouse = makeMouseDevice(Vec3::Zero(), 0.5);
  mouse->setTarget(Vec3(0.05, 0, 0));
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < 400; ++i) {
    const Vec3 tip = mouse->exchange(Vec3::Zero(), kPeriod);
    EXPECT_LE((tip - last).norm(), 0.5 * kPeriod * (1 + 1e-12));
    last = tip;
  }
  EXPECT_NEAR(last.x(), 0.05, 1e-6);
}

TEST(MouseDevice, IgnoresATargetThatIsNotFinite) {
  const auto mouse = makeMouseDevice(Vec3(0, 0, 0.01));
  mouse->setTarget(Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  EXPECT_EQ(mouse->exchange(Vec3::Zero(), kPeriod), Vec3(0, 0, 0.01));
}

TEST(MouseDevice, NeverReadsHalfOfATarget) {
  // Every target lies on the diagonal; a torn read would leave it.
  const auto mouse = makeMouseDevice(Vec3::Zero(), 1e9);
  std::thread writer([&] {
    for (int i = 1; i <= 20000; ++i) mouse->setTarget(Vec3::Constant(i));
  });
  for (int i = 0; i < 20000; ++i) {
    const Vec3 tip = mouse->exchange(Vec3::Zero(), kPeriod);
    ASSERT_EQ(tip.x(), tip.y());
    ASSERT_EQ(tip.x(), tip.z());
  }
  writer.join();
}

} // namespace
} // namespace patina
