#include "geometry/winding/winding_number.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"
#include "support/changed_mesh.h"
#include "support/mesh_defects.h"
#include "support/winding_sum.h"

namespace patina {
namespace {

using test::inverted;

TriangleMesh scaledAndMoved(TriangleMesh mesh, const Vec3& by, double scale = 1) {
  for (Vec3& p : mesh.positions) p = scale * p + by;
  return mesh;
}

std::vector<Vec3> randomPointsAbout(const Box3& box, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-0.1, 1.1);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const Vec3 u(unit(random), unit(random), unit(random));
    points.push_back(box.min() + u.cwiseProduct(box.sizes()));
  }
  return points;
}

// Points at random distances, down to a thousandth of a triangle, from random faces.
std::vector<Vec3> pointsNear(const TriangleMesh& mesh, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::size_t> face(0, mesh.triangles.size() - 1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const std::size_t t = face(random);
    Vec3 weights(unit(random) + 0.05, unit(random) + 0.05, unit(random) + 0.05);
    weights /= weights.sum();
    const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const double far = std::pow(10.0, 4 * unit(random) - 3) * (b - a).norm();
    points.push_back(weights[0] * a + weights[1] * b + weights[2] * c +
                     (i % 2 ? far : -far) * faceNormal(mesh, t));
  }
  return points;
}

double worstError(const TriangleMesh& mesh, const std::vector<Vec3>& points, double accuracy = 2) {
  const WindingNumber fast(mesh, accuracy);
  double worst = 0;
  for (const Vec3& p : points)
    worst = std::max(worst, std::abs(fast.at(p) - windingNumberBruteForce(mesh, p)));
  return worst;
}

// K01: the sum itself is 1 inside and 0 outside.
TEST(WindingNumber, BruteForceIsOneInsideAndZeroOutside) {
  const TriangleMesh mesh = torus(0.04, 0.015, 40, 20);
  EXPECT_NEAR(windingNumberBruteForce(mesh, Vec3(0.04, 0, 0)), 1, 1e-12);
  EXPECT_NEAR(windingNumberBruteForce(mesh, Vec3(0, 0, 0)), 0, 1e-12);
  EXPECT_NEAR(windingNumberBruteForce(mesh, Vec3(0.1, 0.1, 0.1)), 0, 1e-12);
}

TEST(WindingNumber, AgreesWithTheExactSumOnClosedMeshes) {
  for (const TriangleMesh& mesh :
       {icosphere(0.05, 12), torus(0.04, 0.015, 60, 30), box(Vec3(0.1, 0.02, 0.001), 8)}) {
    EXPECT_LT(worstError(mesh, randomPointsAbout(bounds(mesh), 400, 1)), 1e-2);
    EXPECT_LT(worstError(mesh, pointsNear(mesh, 400, 2)), 1e-2);
  }
}

TEST(WindingNumber, AgreesWithTheExactSumOnDefectiveMeshes) {
  const TriangleMesh ball = icosphere(0.05, 12);
  for (const TriangleMesh& mesh :
       {withHoles(ball, 12, 0.01, 3), withFlippedFaces(ball, 0.3, 4),
        withShrunkenTriangles(ball, 0.2), sheet(0.1, 0.1, 20),
        joined(ball, scaledAndMoved(ball, Vec3(0.03, 0.01, 0))), galleon(0.1)}) {
    EXPECT_LT(worstError(mesh, randomPointsAbout(bounds(mesh), 300, 5)), 1e-2);
    EXPECT_LT(worstError(mesh, pointsNear(mesh, 300, 6)), 1e-2);
  }
}

// Second order: the error of an expansion falls with the third power of the distance ratio.
TEST(WindingNumber, AccuracyBuysSmallerErrors) {
  const TriangleMesh mesh = withHoles(icosphere(0.05, 20), 12, 0.01, 7);
  const std::vector<Vec3> points = randomPointsAbout(bounds(mesh), 400, 8);
  const double coarse = worstError(mesh, points, 1.5);
  const double fine = worstError(mesh, points, 4);
  EXPECT_LT(fine, coarse / 8);
  EXPECT_LT(fine, 1e-3);
}

TEST(WindingNumber, SmallMeshesAreSummedExactly) {
  TriangleMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  mesh.triangles = {Triangle{0, 1, 2}};
  const WindingNumber winding(mesh);
  for (const Vec3& p : {Vec3(0.2, 0.2, -1e-4), Vec3(0.2, 0.2, 1e-4), Vec3(0.3, -0.2, 0.4)})
    EXPECT_NEAR(winding.at(p), windingNumberBruteForce(mesh, p), 1e-5);
}

TEST(WindingNumber, IsIndependentOfPositionAndSize) {
  const TriangleMesh mesh = icosphere(1, 10);
  const WindingNumber here(mesh);
  for (const auto& [by, scale] : {std::pair(Vec3(1e6, -1e6, 1e6), 1.0),
                                  std::pair(Vec3(0, 0, 0), 1e-9), std::pair(Vec3(1, 2, 3), 1e9)}) {
    const WindingNumber there(scaledAndMoved(mesh, by, scale));
    for (const Vec3& p : randomPointsAbout(bounds(mesh), 200, 9)) {
      if (std::abs(p.norm() - 1) < 0.02) continue; // between facets and sphere
      EXPECT_NEAR(there.at(scale * p + by), here.at(p), 1e-2);
    }
  }
}

TEST(WindingNumber, InvertedMeshHasTheOppositeSign) {
  const TriangleMesh mesh = icosphere(0.05, 8);
  const WindingNumber winding(inverted(mesh));
  EXPECT_NEAR(winding.at(Vec3(0.01, 0.02, 0)), -1, 1e-2);
  EXPECT_NEAR(winding.at(Vec3(0.06, 0, 0)), 0, 1e-2);
}

TEST(WindingNumber, OverlappingBodiesAdd) {
  const TriangleMesh mesh = icosphere(0.05, 8);
  const WindingNumber winding(joined(mesh, scaledAndMoved(mesh, Vec3(0.04, 0, 0))));
  EXPECT_NEAR(winding.at(Vec3(0.02, 0, 0)), 2, 1e-2);
  EXPECT_NEAR(winding.at(Vec3(-0.03, 0, 0)), 1, 1e-2);
}

TEST(WindingNumber, CoincidentTrianglesCountOnce) {
  const TriangleMesh mesh = icosphere(0.05, 8);
  TriangleMesh rotated = mesh; // the same faces with other first corners
  for (Triangle& t : rotated.triangles) t = {t[1], t[2], t[0]};
  const WindingNumber twice(joined(mesh, rotated));
  EXPECT_NEAR(twice.at(Vec3(0, 0.01, 0)), 1, 1e-2);
  const WindingNumber mostly_outward(joined(joined(inverted(mesh), mesh), mesh));
  EXPECT_NEAR(mostly_outward.at(Vec3(0, 0.01, 0)), 1, 1e-2);
  EXPECT_NEAR(mostly_outward.at(Vec3(0, 0.06, 0)), 0, 1e-2);
}

TEST(WindingNumber, BodyJoinedWithItsInverseHasAnInside) {
  const TriangleMesh mesh = icosphere(0.05, 8);
  for (const TriangleMesh& both : {joined(mesh, inverted(mesh)), joined(inverted(mesh), mesh)}) {
    const WindingNumber winding(both);
    EXPECT_NEAR(std::abs(winding.at(Vec3(0, 0.01, 0))), 1, 1e-2);
    EXPECT_NEAR(winding.at(Vec3(0, 0.06, 0)), 0, 1e-2);
  }
}

// The wall between two touching boxes exists twice with opposite orientation: it must cancel.
TEST(WindingNumber, WallBetweenTouchingBodiesCancels) {
  const TriangleMesh half = box(Vec3(1, 1, 1), 2);
  const TriangleMesh mesh = joined(half, scaledAndMoved(half, Vec3(1, 0, 0)));
  const WindingNumber winding(mesh);
  for (const Vec3& p : {Vec3(0.4, 0.1, 0.2), Vec3(0.6, 0.1, 0.2), Vec3(-0.3, 0, 0)})
    EXPECT_NEAR(winding.at(p), 1, 1e-2);
  EXPECT_NEAR(winding.at(Vec3(0.45, 0.6, 0.1)), 0, 1e-2);
}

TEST(WindingNumber, BadInputIsHarmless) {
  TriangleMesh mesh = icosphere(0.05, 4);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  mesh.positions.emplace_back(nan, 0, 0);
  mesh.triangles.push_back({0, 1, static_cast<std::int32_t>(mesh.positions.size() - 1)});
  mesh.triangles.push_back({3, 3, 3});
  const WindingNumber winding(mesh);
  EXPECT_NEAR(winding.at(Vec3(0, 0.01, 0)), 1, 1e-2);
  EXPECT_EQ(winding.at(Vec3(nan, 0, 0)), 0);
  EXPECT_EQ(winding.at(Vec3(1e300, 0, 0)), 0);
  EXPECT_TRUE(std::isfinite(winding.at(mesh.positions[0]))); // on a corner
  EXPECT_EQ(WindingNumber(TriangleMesh()).at(Vec3::Zero()), 0);
  EXPECT_GT(winding.bytes(), 0U);
}

} // namespace
} // namespace patina
