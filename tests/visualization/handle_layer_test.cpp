// The handle against closed forms: the part under a point, and its motion with the hand.
#include "visualization/layers/handle_layer.h"

#include <gtest/gtest.h>

namespace patina {
namespace {

const HandleView kTop{Vec3(1, 2, 3), Vec3::UnitZ(), 0.5};
const HandleView kFront{Vec3(1, 2, 3), -Vec3::UnitY(), 0.5};

Vec3 at(const HandleView& view, double x, double y, double z) {
  return view.middle + view.radius * Vec3(x, y, z);
}

TEST(Handle, FindsArrowsRingsAndTheBallWhereDrawn) {
  EXPECT_EQ(partAt(kTop, at(kTop, 0, 0, 0)), HandlePart::free);
  EXPECT_EQ(partAt(kTop, at(kTop, 0.5, 0, 0)), HandlePart::shift_x);
  EXPECT_EQ(partAt(kTop, at(kTop, 0.02, 1.4, 0)), HandlePart::shift_y);
  EXPECT_EQ(partAt(kTop, at(kTop, 0.6, -0.8, 0)), HandlePart::turn_z);
  EXPECT_EQ(partAt(kTop, at(kTop, 0.6, 0.5, 0)), std::nullopt);
  EXPECT_EQ(partAt(kTop, at(kTop, 3, 3, 0)), std::nullopt);
  // Rings seen edge on coincide with the other axis's arrow.
  EXPECT_EQ(partAt(kTop, at(kTop, 0, -0.5, 0)), HandlePart::turn_x);
  EXPECT_EQ(partAt(kTop, at(kTop, -0.5, 0, 0)), HandlePart::turn_y);
  EXPECT_EQ(partAt(kFront, at(kFront, 0, 0, 0.7)), HandlePart::shift_z);
  EXPECT_EQ(partAt(kFront, at(kFront, 0.6, 0, 0.8)), HandlePart::turn_y);
}

TEST(Handle, ArrowShiftsAlongItsAxisOnly) {
  const Pose motion =
      handleMotion(kTop, HandlePart::shift_x, at(kTop, 0.5, 0, 0), at(kTop, 0.9, 0.7, 0));
  EXPECT_TRUE(motion.linear().isIdentity(1e-12));
  EXPECT_TRUE(motion.translation().isApprox(Vec3(0.2, 0, 0), 1e-12));
}

TEST(Handle, RingTurnsAboutTheMiddleWithTheHand) {
  for (const HandleView& view : {kTop, HandleView{kTop.middle, -Vec3::UnitZ(), kTop.radius}}) {
    const Vec3 from = at(view, 1, 0, 0), to = at(view, std::cos(0.4), std::sin(0.4), 0);
    const Pose motion = handleMotion(view, HandlePart::turn_z, from, to);
    EXPECT_TRUE((motion * from).isApprox(to, 1e-12));
    EXPECT_TRUE((motion * view.middle).isApprox(view.middle, 1e-12));
    EXPECT_NEAR(Eigen::AngleAxisd(motion.linear()).angle(), 0.4, 1e-12);
  }
}

// The near side of the ring follows the hand to first order.
TEST(Handle, RingSeenEdgeOnRollsWithTheHand) {
  const Vec3 from = at(kTop, 0, -0.5, 0);
  const Pose motion = handleMotion(kTop, HandlePart::turn_x, from, from + Vec3(0, 1e-4, 0));
  const Vec3 near = at(kTop, 0, 0, 1);
  EXPECT_LT((motion * near - near - Vec3(0, 1e-4, 0)).norm(), 1e-7);
  EXPECT_TRUE((motion * kTop.middle).isApprox(kTop.middle, 1e-12));
}

TEST(Handle, BallShiftsInThePlaneOfThePicture) {
  const Pose motion =
      handleMotion(kFront, HandlePart::free, at(kFront, 0, 0, 0), at(kFront, 1, 0, -2));
  EXPECT_TRUE(motion.translation().isApprox(Vec3(0.5, 0, -1), 1e-12));
}

} // namespace
} // namespace patina
