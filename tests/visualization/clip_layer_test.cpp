#include "visualization/layers/clip_layer.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patina {
namespace {

// An eye at (0.3, -2, 0.4) that looks at a point.
Ray sightOf(const Vec3& point) {
  const Vec3 eye(0.3, -2, 0.4);
  return {eye, (point - eye).normalized()};
}

TEST(ClipHandle, BallAndShaftShiftHeadTiltsAndBesideIsNothing) {
  const ClipPlane plane{Vec3(0.1, 0.2, 0.3), Vec3(1, 2, 2) / 3};
  const auto on = [&](double part) { return sightOf(plane.origin + 0.5 * part * plane.normal); };
  EXPECT_EQ(clipPartAt(plane, 0.5, on(0)), ClipPart::shift);
  EXPECT_EQ(clipPartAt(plane, 0.5, on(0.4)), ClipPart::shift);
  EXPECT_EQ(clipPartAt(plane, 0.5, on(0.9)), ClipPart::tilt);
  EXPECT_EQ(clipPartAt(plane, 0.5, on(1)), ClipPart::tilt);
  EXPECT_FALSE(clipPartAt(plane, 0.5, on(1.4)).has_value());
  EXPECT_FALSE(clipPartAt(plane, 0.5, on(-0.4)).has_value());
}

TEST(ClipHandle, ShiftFollowsThePointerAlongTheNormalOnly) {
  const ClipPlane plane{Vec3(0.1, 0.2, 0.3), Vec3(2, 1, 2) / 3};
  for (const double way : {-0.2, 0.05, 0.3}) {
    const Vec3 held = plane.origin + 0.2 * plane.normal;
    const ClipPlane moved =
        clipShifted(plane, sightOf(held), sightOf(held + way * plane.normal), Vec3::UnitZ());
    EXPECT_EQ(moved.normal, plane.normal);
    EXPECT_LT((moved.origin - plane.origin - way * plane.normal).norm(), 1e-9) << way;
  }
}

TEST(ClipHandle, ArrowTowardsTheViewerShiftsByMovingUp) {
  const ClipPlane plane{Vec3::Zero(), -Vec3::UnitY()};
  const Ray from{Vec3(0, -2, 0), Vec3::UnitY()};
  const Ray to{Vec3(0, -2, 0), Vec3(0.1, 2, 0.05).normalized()};
  const ClipPlane moved = clipShifted(plane, from, to, Vec3::UnitZ());
  EXPECT_LT(moved.origin.y(), -0.02);
  EXPECT_NEAR(moved.origin.x(), 0, 1e-12);
}

TEST(ClipHandle, TiltPointsTheArrowToThePointer) {
  const ClipPlane plane{Vec3(0.1, 0.2, 0.3), -Vec3::UnitY()};
  for (const Vec3& normal : {Vec3(0.4, -0.8, 0.3), Vec3(-0.5, -0.7, -0.4)}) {
    const Vec3 head = plane.origin + 0.5 * normal.normalized();
    const ClipPlane tilted = clipTilted(plane, 0.5, sightOf(head));
    EXPECT_EQ(tilted.origin, plane.origin);
    EXPECT_LT((tilted.normal - normal.normalized()).norm(), 1e-9);
  }
  const Ray sight = sightOf(plane.origin + Vec3(3, 0, 0));
  const ClipPlane beside = clipTilted(plane, 0.5, sight);
  EXPECT_NEAR(beside.normal.norm(), 1, 1e-12);
  EXPECT_NEAR(beside.normal.dot(sight.direction), 0, 1e-9) << "the ball's rim";
  EXPECT_GT(beside.normal.x(), 0.5);
}

TEST(ClipHandle, TiltSnapsToANearAxis) {
  const ClipPlane plane{Vec3::Zero(), -Vec3::UnitY()};
  const auto tilted = [&](double degrees) {
    const double angle = degrees * M_PI / 180;
    return clipTilted(plane, 0.5, sightOf(0.5 * Vec3(std::sin(angle), -std::cos(angle), 0))).normal;
  };
  EXPECT_EQ(tilted(3), Vec3(-Vec3::UnitY()));
  EXPECT_LT((tilted(6) - Vec3(std::sin(M_PI / 30), -std::cos(M_PI / 30), 0)).norm(), 1e-9);
}

TEST(ClipPlane, SightStartsOnThePlaneIfTheEyeIsInTheCutPart) {
  const ClipPlane plane{Vec3(0, 0.5, 0), -Vec3::UnitY()};
  const Ray sight = sightOf(Vec3(0, 1, 0));
  const auto rest = behind(plane, sight);
  ASSERT_TRUE(rest.has_value());
  EXPECT_NEAR(rest->origin.y(), 0.5, 1e-12);
  EXPECT_LT((rest->origin - sight.origin).cross(sight.direction).norm(), 1e-12) << "on the sight";
  EXPECT_FALSE(behind(plane, {sight.origin, -sight.direction}).has_value());
  const Ray inner{Vec3(0, 2, 0), Vec3::UnitX()};
  EXPECT_EQ(behind(plane, inner)->origin, inner.origin) << "the kept file has it";
}

} // namespace
} // namespace patina
