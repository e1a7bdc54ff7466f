// Edits ramp their parameters (F13: the force itself is never limited in rate).
#include <cmath>

#include <gtest/gtest.h>

#include "app/gui/haptic_ramp.h"

namespace patina {
namespace {

int stepsBetween(HapticProperties now, const HapticProperties& wanted) {
  int steps = 0;
  while (!same(now, wanted) && steps < 1000) {
    const HapticProperties next = steppedTowards(now, wanted);
    Scene scene;
    scene.haptics = next;
    EXPECT_NO_THROW(validate(scene)) << "step " << steps;
    EXPECT_LE(std::abs(std::log(next.stiffness / now.stiffness)), std::log(1.0801));
    EXPECT_LE(std::abs(next.tip_radius.value_or(0) - now.tip_radius.value_or(0)), 0.5001e-3);
    now = next;
    ++steps;
  }
  return steps;
}

HapticProperties full() {
  HapticProperties haptics;
  haptics.stiffness = 3000;
  haptics.damping = 10;
  haptics.tip_radius = 4e-3;
  haptics.friction = Friction{1.2, 0.7, 0.5, Friction::SlipDirection::displacement};
  return haptics;
}

TEST(HapticRamp, ReachesEveryValueExactlyAndInUnderASecondAndAHalf) {
  EXPECT_LE(stepsBetween(HapticProperties{}, full()), 45);
}

TEST(HapticRamp, ValuesGoAwayByWayOfNothing) {
  EXPECT_LE(stepsBetween(full(), HapticProperties{}), 45);
}

TEST(HapticRamp, NothingToDoIsNoStep) {
  EXPECT_EQ(stepsBetween(full(), full()), 0);
}

TEST(HapticRamp, ASmallEditIsOneStep) {
  HapticProperties wanted = full();
  wanted.stiffness *= 1.05;
  wanted.force_limit = 5;
  EXPECT_EQ(stepsBetween(full(), wanted), 1);
}

} // namespace
} // namespace patina
