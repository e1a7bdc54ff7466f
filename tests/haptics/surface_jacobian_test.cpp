// J of the closest point (F6) against closed forms.
#include <gtest/gtest.h>

#include "field/store/four.h"
#include "haptics/contact/pull_back.h"
#include "haptics/painted_fixture.h"

namespace patina {

namespace jacobian_plain { // surface_jacobian.cpp
void jacobianOf(const Float4* low, float x, float y, float z, const double* n, double depth,
                double iso, double* columns) noexcept;
}

namespace {

Vec3 directionAt(std::mt19937& random) {
  std::normal_distribution<double> any;
  return Vec3(any(random), any(random), any(random)).normalized();
}

Eigen::Matrix3d matrixOf(const SurfaceJacobian& jacobian) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i) m.col(i) = jacobian * Vec3::Unit(i);
  return m;
}

// Largest error of J at random points of a ball, or of a hollow of its size. The point on the
// surface moves R / rho times as far as the tip, rho being the tip's distance from the centre.
double ballError(int cells, bool hollow, double iso, double depth) {
  const double R = 0.03, sign = hollow ? -1 : 1, voxel = 2 * R / (cells - 16);
  const Field field = cubeField([=](const Vec3& p) { return sign * (p.norm() - R); }, voxel, cells);
  const FieldSampler sampler(*field, Sampler::high);
  std::mt19937 random(3);
  double worst = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 n = directionAt(random);
    BandCell cell;
    EXPECT_TRUE(sampler.cellAt(sampler.toGrid((R + sign * iso * voxel) * n), cell));
    const double rho = R + sign * (iso - depth) * voxel;
    const Eigen::Matrix3d truth = R / rho * (Eigen::Matrix3d::Identity() - n * n.transpose());
    worst = std::max(worst, (matrixOf(SurfaceJacobian(cell, sign * n, depth, iso)) - truth).norm());
  }
  return worst;
}

TEST(SurfaceJacobian, MatchesTheClosedFormOfABallAndAHollow) {
  for (const bool hollow : {false, true})
    for (const double iso : {0.0, 1.5, 4.0})
      for (const double depth : {-1.0, 0.5, 3.0, 6.0}) {
        const double coarse = ballError(76, hollow, iso, depth),
                     fine = ballError(136, hollow, iso, depth);
        SCOPED_TRACE(testing::Message() << hollow << ", iso " << iso << ", depth " << depth << ": "
                                        << coarse << " " << fine);
        EXPECT_LT(coarse, 8e-3);
        EXPECT_LT(fine, std::max(0.6 * coarse, 1e-5)); // its voxels are half as large
      }
}

// The tip near the axis of a limb, at it and beyond: J is limited to 4 across the axis and stays 1
// along it.
TEST(SurfaceJacobian, IsLimitedNearTheAxisOfALimb) {
  const double r = 6; // voxels
  const double voxel = 0.5e-3;
  const Field field =
      cubeField([=](const Vec3& p) { return std::hypot(p.x(), p.y()) - r * voxel; }, voxel, 48);
  const FieldSampler sampler(*field, Sampler::high);
  for (const double iso : {0.0, 2.0})
    for (const double share : {0.2, 0.5, 0.9, 0.99, 1.0, 1.2}) {
      const double depth = share * (r + iso), exact = r / (r + iso - depth);
      const Vec3 n = Vec3(3, 4, 0) / 5, around(-n.y(), n.x(), 0);
      BandCell cell;
      ASSERT_TRUE(sampler.cellAt(sampler.toGrid((r + iso) * voxel * n), cell));
      const SurfaceJacobian jacobian(cell, n, depth, iso);
      SCOPED_TRACE(testing::Message() << "iso " << iso << ", share " << share);
      EXPECT_NEAR((jacobian * Vec3::UnitZ()).z(), 1, 1e-4);
      const double across = (jacobian * around).dot(around);
      if (share < 0.8)
        EXPECT_NEAR(across, exact, 0.06 * exact);
      else
        EXPECT_NEAR(across, 4, 1e-5);
      EXPECT_NEAR((jacobian * n).norm(), 0, 1e-4);
    }
}

// Two different curvatures, also in sign, at random points of a ring and depths.
TEST(SurfaceJacobian, MatchesTheClosedFormOfARing) {
  const double R = 0.03, r = 0.012, voxel = 0.5e-3; // 24 voxels about the tube
  const Field field = cubeField(
      [=](const Vec3& p) { return std::hypot(p.head<2>().norm() - R, p.z()) - r; }, voxel, 200);
  const FieldSampler sampler(*field, Sampler::high);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> turn(-3.14159, 3.14159), any(0, 1);
  double worst = 0;
  for (int k = 0; k < 1000; ++k) {
    const double about = turn(random), along = turn(random), iso = 3 * any(random),
                 depth = 8 * any(random);
    const Vec3 to(std::cos(along), std::sin(along), 0), ahead(-to.y(), to.x(), 0),
        n = std::cos(about) * to + std::sin(about) * Vec3::UnitZ(), around = n.cross(ahead);
    BandCell cell;
    ASSERT_TRUE(sampler.cellAt(sampler.toGrid(R * to + (r + iso * voxel) * n), cell));
    const double out = (iso - depth) * voxel;
    const Eigen::Matrix3d truth =
        r / (r + out) * around * around.transpose() +
        (R + r * std::cos(about)) / (R + (r + out) * std::cos(about)) * ahead * ahead.transpose();
    worst = std::max(worst, (matrixOf(SurfaceJacobian(cell, n, depth, iso)) - truth).norm());
  }
  EXPECT_LT(worst, 0.02);
}

// An outer edge stays where it is while a tip of `iso` voxels goes round it: J across it is of the
// order of a voxel against the radius, at any position of the edge in its cells.
TEST(SurfaceJacobian, VanishesAcrossOuterEdges) {
  const double voxel = 0.5e-3;
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(0, 1);
  for (const double iso : {2.0, 3.0, 5.0, 7.0})
    for (const double share : {0.0, 0.5, 0.9, 0.97}) {
      double sum = 0, most = 0;
      constexpr int kPlaces = 40, kAngles = 10;
      for (int place = 0; place < kPlaces; ++place) {
        const Vec3 edge = voxel * Vec3(any(random), any(random), 0);
        const Field field = cubeField(
            [=](const Vec3& p) {
              const double x = p.x() - edge.x(), y = p.y() - edge.y();
              return x > 0 && y > 0 ? std::hypot(x, y) : std::max(x, y);
            },
            voxel, 24, 9);
        const FieldSampler sampler(*field, Sampler::high);
        for (int k = 0; k < kAngles; ++k) {
          const double angle = 0.1 + 1.37 * any(random);
          const Vec3 n(std::cos(angle), std::sin(angle), 0), around(-n.y(), n.x(), 0);
          BandCell cell;
          ASSERT_TRUE(sampler.cellAt(
              sampler.toGrid(edge + iso * voxel * n + any(random) * voxel * Vec3::UnitZ()), cell));
          const SurfaceJacobian jacobian(cell, n, share * iso, iso);
          const double across = (jacobian * around).norm();
          sum += across;
          most = std::max(most, across);
          ASSERT_NEAR((jacobian * Vec3::UnitZ()).z(), 1, 1e-3);
        }
      }
      std::printf("tip of %g voxels, %.2f of it deep: %.3f across the edge, %.3f at most\n", iso,
                  share, sum / (kPlaces * kAngles), most);
      EXPECT_LT(sum / (kPlaces * kAngles), (share > 0.95 ? 2 : 1) / iso);
      EXPECT_LE(most, 1);
    }
}

// The contact stage's Jacobian equals the one of an evaluation at the surface itself.
TEST(SurfaceJacobian, InContactEqualsTheOneAtTheSurface) {
  const double R = 0.03;
  const Field field = sphereField(R);
  Scene scene = sceneOf(500);
  for (const double radius : {0.0, 2e-3}) {
    if (radius > 0) scene.haptics.tip_radius = radius;
    const auto map = coveredMap(field->grid.voxel, cube(R + 2e-3), MaterialChannel::stiffness,
                                [](const Vec3& p) { return 600 + 5e3 * p.x(); });
    const HapticObject object = hapticMaterial(*map, scene);
    const auto snapshot = compileStages(scene, field, std::span(&object, 1));
    const FieldSampler sampler(*field, Sampler::high);
    ContactMemory memory;
    int known = 0;
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
      const double t = 2e-3 * i;
      const Vec3 n(std::sin(1 + 0.3 * t) * std::cos(t), std::sin(1 + 0.3 * t) * std::sin(t),
                   std::cos(1 + 0.3 * t));
      Contact contact =
          tick(*snapshot, memory, (R + radius - 1e-3 - 0.4e-3 * std::sin(9 * t)) * n, 1e-3);
      if (!contact.touching || !contact.jacobian) continue;
      ++known;
      const Eigen::Matrix3d told = matrixOf(*contact.jacobian);
      worst = std::max(worst, (told - matrixOf(jacobianOf(sampler, contact))).norm());
    }
    EXPECT_GT(known, 1900);
    EXPECT_LT(worst, 3e-3) << "tip of " << radius;
  }
}

TEST(SurfaceJacobian, IsTheSameOnEveryProcessor) {
  const Field field = sphereField();
  const FieldSampler sampler(*field, Sampler::high);
  std::mt19937 random(5);
  for (int k = 0; k < 200; ++k) {
    const Vec3 n = directionAt(random);
    BandCell cell;
    ASSERT_TRUE(sampler.cellAt(sampler.toGrid(0.0305 * n), cell));
    Eigen::Matrix<double, 4, 3> columns;
    const double depth = k % 2 == 0 ? 2 : 60; // limited as well
    jacobian_plain::jacobianOf(reinterpret_cast<const Float4*>(cell.node), cell.fx, cell.fy,
                               cell.fz, n.data(), depth, 1, columns.data());
    const Eigen::Matrix3d here = matrixOf(SurfaceJacobian(cell, n, depth, 1));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) ASSERT_NEAR(columns(i, j), here(i, j), depth > 2 ? 5e-5 : 1e-6);
  }
}

} // namespace
} // namespace patina
