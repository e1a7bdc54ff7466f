// Lengths over a mesh and fitted radii, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/measure/fit_shape.h"
#include "geometry/measure/geodesic.h"
#include "geometry/measure/mesh_part.h"
#include "geometry/measure/patch_area.h"
#include "geometry/mesh/shapes.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

// Prism of a circle, without caps; its vertices lie on a cylinder about z.
TriangleMesh tube(double radius, double height, int around, int along) {
  TriangleMesh mesh;
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * i / around;
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                  height * j / along);
    }
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      const int a = j * around + i, b = j * around + (i + 1) % around;
      mesh.triangles.push_back({a, b, b + around});
      mesh.triangles.push_back({a, b + around, a + around});
    }
  return mesh;
}

struct Measured {
  explicit Measured(TriangleMesh shape)
      : mesh(std::move(shape)), neighbours(adjacency(mesh)), tree(mesh) {}
  SurfacePoint on(const Vec3& p) const { return tree.closestPoint(p).surface; }
  double over(const Vec3& a, const Vec3& b) const {
    const auto path = geodesicPath(mesh, neighbours, on(a), on(b));
    EXPECT_TRUE(path);
    if (!path) return -1;
    double sum = 0;
    for (std::size_t i = 1; i < path->points.size(); ++i)
      sum += (path->points[i] - path->points[i - 1]).norm();
    EXPECT_NEAR(sum, path->length, 1e-12 + 1e-9 * sum) << "the drawn path has the length";
    return path->length;
  }
  TriangleMesh mesh;
  Adjacency neighbours;
  TriangleTree tree;
};

TEST(Geodesic, IsStraightOverAnUnevenSheet) {
  TriangleMesh mesh = sheet(0.1, 0.1, 20);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> jitter(-0.0015, 0.0015), place(-0.047, 0.047);
  for (Vec3& p : mesh.positions)
    if (std::abs(p.x()) < 0.049 && std::abs(p.y()) < 0.049)
      p += Vec3(jitter(random), jitter(random), 0);
  const Measured m(mesh);
  for (int i = 0; i < 40; ++i) {
    const Vec3 a(place(random), place(random), 0), b(place(random), place(random), 0);
    EXPECT_NEAR(m.over(a, b), (b - a).norm(), 1e-12);
  }
}

TEST(Geodesic, UnfoldsTheFacesOfABox) {
  for (const int cells : {1, 7}) {
    const Measured m(box(Vec3::Constant(0.1), cells));
    const double h = 0.05;
    EXPECT_NEAR(m.over({h, -h, -h}, {h, h, -h}), 0.1, 1e-12) << "an edge";
    // The path crosses the edge between top and side, straight in the unfolded faces.
    EXPECT_NEAR(m.over({0.01, -0.02, h}, {h, 0.03, 0.02}), std::hypot(0.04 + 0.03, 0.05), 1e-12);
    // Opposite corners of a cube: sqrt(5) sides.
    EXPECT_NEAR(m.over({-h, -h, -h}, {h, h, h}), 0.1 * std::sqrt(5), 1e-12);
  }
}

TEST(Geodesic, FollowsTheGreatCirclesOfABall) {
  const Measured m(icosphere(0.03, 40));
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10; ++i) {
    const Vec3 a = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Vec3 b = Vec3(normal(random), normal(random), normal(random)).normalized();
    const double arc = 0.03 * std::acos(a.dot(b));
    EXPECT_NEAR(m.over(0.03 * a, 0.03 * b), arc, 1e-3 * arc);
  }
}

TEST(Geodesic, FollowsTheHelicesOfATube) {
  const double radius = 0.02;
  const Measured m(tube(radius, 0.1, 200, 50));
  const auto at = [&](double angle, double z) {
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (const double turn : {0.3, 1.0, 2.5})
    EXPECT_NEAR(m.over(at(0.2, 0.01), at(0.2 + turn, 0.08)), std::hypot(radius * turn, 0.07),
                2e-4 * 0.07);
}

// A cone unrolls to a sector: the shorter way round is a chord of it.
TEST(Geodesic, TakesTheShorterWayRoundAConeOfManyFaces) {
  constexpr int kAround = 400, kAlong = 100;
  constexpr double kSlant = 0.08, kRadius = 0.05;
  TriangleMesh cone = tube(kRadius, 1, kAround, kAlong);
  for (Vec3& p : cone.positions) {
    const double slant = kSlant * (0.02 + 0.98 * p.z());
    p.head<2>() *= slant / kSlant;
    p.z() = -slant * std::sqrt(1 - kRadius * kRadius / kSlant / kSlant);
  }
  const Measured m(cone);
  ASSERT_GT(cone.triangles.size(), 50'000U);
  std::mt19937 random(8);
  std::uniform_int_distribution<int> around(0, kAround - 1), along(30, kAlong);
  for (int i = 0; i < 12; ++i) {
    const int first = around(random), low = along(random), high = along(random);
    // Half way round less up to 1 %: the two ways differ by some tenths of a percent or more.
    const int second = (first + kAround / 2 - 1 - i % 4) % kAround;
    const auto slantAt = [&](int row) { return kSlant * (0.02 + 0.98 * row / kAlong); };
    const double angle = 2 * M_PI * kRadius / kSlant * (kAround / 2 - 1 - i % 4) / kAround;
    const double a = slantAt(low), b = slantAt(high);
    const double chord = std::sqrt(a * a + b * b - 2 * a * b * std::cos(angle));
    const double length = m.over(cone.positions[static_cast<std::size_t>(low * kAround + first)],
                                 cone.positions[static_cast<std::size_t>(high * kAround + second)]);
    EXPECT_NEAR(length, chord, 2e-4 * chord) << i;
  }
}

TEST(Geodesic, JoinsOppositePointsOfABallOfManyFaces) {
  const Measured m(icosphere(0.03, 80));
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 4; ++i) {
    const Vec3 a = 0.03 * Vec3(normal(random), normal(random), normal(random)).normalized();
    EXPECT_NEAR(m.over(a, -a), 0.03 * M_PI, 5e-4 * 0.03 * M_PI);
  }
}

TEST(Geodesic, IsAsLongBackAsForthFromVerticesEdgesAndFaces) {
  std::mt19937 random(3);
  for (const TriangleMesh& mesh : {icosphere(0.03, 20), vase()}) {
    const Measured m(mesh);
    std::uniform_int_distribution<std::int32_t> any(
        0, static_cast<std::int32_t>(mesh.triangles.size()) - 1);
    const Vec3 places[] = {{1, 0, 0}, {0.5, 0.5, 0}, {0.2, 0.3, 0.5}};
    for (int i = 0; i < 45; ++i) {
      const SurfacePoint a{any(random), places[i % 3]}, b{any(random), places[i % 3]};
      const auto forth = geodesicPath(m.mesh, m.neighbours, a, b);
      const auto back = geodesicPath(m.mesh, m.neighbours, b, a);
      ASSERT_TRUE(forth && back);
      EXPECT_NEAR(forth->length, back->length, 1e-3 * back->length);
      EXPECT_GE(forth->length, (position(mesh, a) - position(mesh, b)).norm() * (1 - 1e-12));
    }
  }
}

TEST(Geodesic, IsTheSameFromThePartOfTheMeshThatItNeeds) {
  std::mt19937 random(5);
  for (const TriangleMesh& mesh : {icosphere(0.03, 20), vase(), box(Vec3::Constant(0.1), 7)}) {
    const Measured m(mesh);
    std::uniform_int_distribution<std::int32_t> any(
        0, static_cast<std::int32_t>(mesh.triangles.size()) - 1);
    for (int i = 0; i < 8; ++i) {
      const SurfacePoint a{any(random), {0.2, 0.3, 0.5}}, b{any(random), {0.6, 0.1, 0.3}};
      const auto whole = geodesicPath(m.mesh, m.neighbours, a, b), part = geodesicPath(mesh, a, b);
      ASSERT_TRUE(whole && part);
      EXPECT_NEAR(part->length, whole->length, 1e-3 * whole->length);
    }
  }
}

TEST(Geodesic, FollowsDetoursOfAnyLengthAndCanBeCancelled) {
  // The points are 2 mm apart, on both sides of a wall that is 0.1 m high.
  const TriangleMesh wall = box(Vec3(0.1, 2e-3, 0.1), 10);
  const Measured m(wall);
  const SurfacePoint front = m.on({0, -1e-3, 0}), back = m.on({0, 1e-3, 0});
  const auto path = geodesicPath(wall, front, back);
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->length, 0.102, 1e-12);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(geodesicPath(wall, front, back, progress), Cancelled);
}

TEST(PartOfAMesh, HasEveryFaceThatAPathOfTheLengthCanReach) {
  const TriangleMesh ball = icosphere(0.03, 12);
  const Vec3 a(0.03, 0, 0), b(0.02, 0.022, 0);
  const double longest = 1.3 * (b - a).norm();
  const MeshPart part = partWithin(ball, a, b, longest);
  EXPECT_LT(part.face.size(), ball.triangles.size() / 4);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t f = 0; f < ball.triangles.size(); ++f)
    for (int i = 0; i < 20; ++i) {
      const double u = unit(random), v = (1 - u) * unit(random);
      const Vec3 p =
          u * ball.corner(f, 0) + v * ball.corner(f, 1) + (1 - u - v) * ball.corner(f, 2);
      if ((p - a).norm() + (p - b).norm() > longest) continue;
      EXPECT_TRUE(std::binary_search(part.face.begin(), part.face.end(), f));
    }
  for (std::size_t i = 0; i < part.face.size(); ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(part.mesh.corner(i, k), ball.corner(static_cast<std::size_t>(part.face[i]), k));
}

TEST(Geodesic, FindsNoPathBetweenPartsThatDoNotTouch) {
  TriangleMesh two = sheet(0.1, 0.1, 2);
  const TriangleMesh other = sheet(0.1, 0.1, 2);
  const auto first = static_cast<std::int32_t>(two.positions.size());
  for (const Vec3& p : other.positions) two.positions.push_back(p + Vec3(0, 0, 1));
  for (const Triangle& t : other.triangles)
    two.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const Measured m(two);
  EXPECT_FALSE(geodesicPath(m.mesh, m.neighbours, m.on({0, 0, 0}), m.on({0, 0, 1})));
}

TEST(FitSphere, FindsTheRadiusOfABallFromAPatch) {
  const Measured m(icosphere(0.03, 24));
  const SurfacePoint at = m.on({0.01, 0.02, 0.03});
  const MeshPatch patch = patchAround(m.mesh, m.neighbours, at, 0.006);
  EXPECT_GT(patch.points.size(), 10U);
  EXPECT_LT(patch.points.size(), m.mesh.positions.size() / 10);
  const auto sphere = fitSphere(patch.points);
  ASSERT_TRUE(sphere);
  EXPECT_NEAR(sphere->radius, 0.03, 1e-3 * 0.03);
  EXPECT_LT(sphere->centre.norm(), 1e-3 * 0.03);
  EXPECT_LT(sphere->rms, 1e-8);
  EXPECT_FALSE(fitSphere({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)})) << "flat";
}

TEST(FitCylinder, FindsRadiusAndAxisOfATube) {
  TriangleMesh mesh = tube(0.02, 0.1, 90, 40);
  const Pose pose =
      Eigen::Translation3d(0.3, -0.2, 1) * Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized());
  for (Vec3& p : mesh.positions) p = pose * p;
  const Measured m(mesh);
  const MeshPatch patch =
      patchAround(m.mesh, m.neighbours, m.on(pose * Vec3(0.02, 0, 0.05)), 0.012);
  const auto cylinder = fitCylinder(m.mesh, patch);
  ASSERT_TRUE(cylinder);
  EXPECT_NEAR(cylinder->radius, 0.02, 1e-3 * 0.02);
  EXPECT_NEAR(std::abs(cylinder->axis.dot(pose.linear() * Vec3::UnitZ())), 1, 1e-6);
  EXPECT_FALSE(fitCylinder(m.mesh, {{0}, {}}));
}

TEST(PatchAround, EndsAtACrease) {
  const Measured m(box(Vec3::Constant(0.1), 10));
  const MeshPatch patch = patchAround(m.mesh, m.neighbours, m.on({0, 0, 0.05}), 1);
  EXPECT_EQ(patch.faces.size(), 200U);
  for (const Vec3& p : patch.points) EXPECT_NEAR(p.z(), 0.05, 1e-12);
}

TEST(PatchArea, IsThatOfADiscOnCoarseAndFineMeshes) {
  for (const int cells : {1, 3, 40}) {
    const Measured m(sheet(0.1, 0.1, cells));
    for (const double radius : {0.002, 0.02}) {
      const Vec3 middle(0.011, -0.007, 0);
      // Another disc elsewhere does not count.
      const auto cover = [&](const SurfacePoint& at) {
        const Vec3 p = position(m.mesh, at);
        const double off = std::min((p - middle).norm(), (p - Vec3(-0.03, 0.03, 0)).norm());
        return 0.5 + (radius - off) / 0.001;
      };
      EXPECT_NEAR(patchArea(m.mesh, m.neighbours, m.on(middle), cover), M_PI * radius * radius,
                  3e-3 * M_PI * radius * radius)
          << cells << " cells, " << radius;
    }
    EXPECT_EQ(patchArea(m.mesh, m.neighbours, m.on({0, 0, 0}), [](const auto&) { return 0.; }), 0);
  }
}

TEST(PatchArea, IsThatOfACapOfABall) {
  const Measured m(icosphere(0.03, 40));
  const auto cover = [&](const SurfacePoint& at) {
    return position(m.mesh, at).z() > 0.02 ? 1.0 : 0.0;
  };
  EXPECT_NEAR(patchArea(m.mesh, m.neighbours, m.on({0, 0, 0.03}), cover), 2 * M_PI * 0.03 * 0.01,
              5e-3 * 2 * M_PI * 0.03 * 0.01);
}

} // namespace
} // namespace patina
