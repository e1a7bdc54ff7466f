#include "demo/truth_errors.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace patina {
namespace {

TEST(TrueForce, IsTheSpringForceOnAPlane) {
  const Vec3 force = referenceForce([](const Vec2&) { return 0.; }, {0.01, 0.02, -1e-3}, 500, 1e-3);
  EXPECT_NEAR((force - Vec3(0, 0, 0.5)).norm(), 0, 1e-9);
}

TEST(TrueForce, IsAlongTheNormalOfATiltedPlane) {
  const double slope = 0.4;
  const Vec3 normal = Vec3(-slope, 0, 1).normalized();
  const Vec3 force = referenceForce([&](const Vec2& p) { return slope * p.x(); },
                                    Vec3(0.003, 0, slope * 0.003) - 0.5e-3 * normal, 2000, 0.8e-3);
  EXPECT_NEAR((force - 1.0 * normal).norm(), 0, 1e-6);
}

TEST(TrueForce, PointsAwayFromTheCentreOfASphere) {
  const double radius = 0.02;
  const auto ball = [&](const Vec2& p) { return std::sqrt(radius * radius - p.squaredNorm()); };
  const Vec3 way = Vec3(0.2, -0.1, 1).normalized();
  const Vec3 force = referenceForce(ball, (radius - 0.4e-3) * way, 1000, 0.8e-3);
  EXPECT_NEAR((force - 0.4 * way).norm(), 0, 1e-6);
}

TEST(TrueForce, IsZeroAboveTheSurface) {
  const auto wave = [](const Vec2& p) { return 1e-4 * std::cos(2000 * p.x()); };
  EXPECT_EQ(referenceForce(wave, {0, 0, 1.1e-4}, 500, 1e-3), Vec3::Zero());
}

} // namespace
} // namespace patina
