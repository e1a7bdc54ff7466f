// Queries of the tree against brute force over all triangles (T-K02's oracle).
#include "geometry/tree/triangle_tree.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

Vec3 randomPoint(std::mt19937& random, double half) {
  std::uniform_real_distribution<double> u(-half, half);
  return {u(random), u(random), u(random)};
}

TriangleMesh soup(int count, double size, unsigned seed) {
  std::mt19937 random(seed);
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = randomPoint(random, 1);
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + randomPoint(random, size));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TriangleMesh oneTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{a, b, c}, {{0, 1, 2}}, {}};
}

// Repeated corners, collinear corners and needles among valid triangles.
TriangleMesh degenerate() {
  TriangleMesh mesh = joined(oneTriangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}),
                             oneTriangle({1, 0, 0}, {1, 0, 0}, {1, 1, 0}));
  mesh = joined(mesh, oneTriangle({-1, 0, 0}, {-1, 1, 1}, {-1, 2, 2}));
  mesh = joined(mesh, oneTriangle({-2, -1, 0}, {2, -1, 0}, {0, -1 + 1e-7, 0}));
  mesh = joined(mesh, oneTriangle({-2, -1, 1}, {2, -1, 1}, {2, -1 + 1e-9, 1}));
  return joined(mesh, soup(20, 0.3, 5));
}

struct BruteForce {
  double distance = kInf;
  std::int32_t face = -1;
};

// A distance that shares no code with the tree: the triangle's plane, else its edges.
double triangleDistance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto segment = [&](const Vec3& u, const Vec3& v) {
    const double l2 = (v - u).squaredNorm();
    const double t = l2 > 0 ? std::clamp((p - u).dot(v - u) / l2, 0.0, 1.0) : 0.0;
    return (p - u - t * (v - u)).norm();
  };
  const Vec3 n = (b - a).cross(c - a);
  const bool inside = n.squaredNorm() > 0 && n.dot((b - a).cross(p - a)) > 0 &&
                      n.dot((c - b).cross(p - b)) > 0 && n.dot((a - c).cross(p - c)) > 0;
  if (inside) return std::abs(n.normalized().dot(p - a));
  return std::min({segment(a, b), segment(b, c), segment(c, a)});
}

BruteForce bruteForce(const TriangleMesh& mesh, const Vec3& p) {
  BruteForce best;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const double d = triangleDistance(p, mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2));
    if (d < best.distance) best = {d, static_cast<std::int32_t>(i)};
  }
  return best;
}

void expectClosest(const TriangleMesh& mesh, const std::vector<Vec3>& points, double tolerance) {
  const TriangleTree tree(mesh);
  for (const Vec3& p : points) {
    const BruteForce truth = bruteForce(mesh, p);
    const ClosestPoint found = tree.closestPoint(p);
    ASSERT_NEAR(found.distance, truth.distance, tolerance) << p.transpose();
    ASSERT_GE(found.surface.face, 0);
    const auto face = static_cast<std::size_t>(found.surface.face);
    ASSERT_NEAR(
        triangleDistance(p, mesh.corner(face, 0), mesh.corner(face, 1), mesh.corner(face, 2)),
        truth.distance, tolerance);
    ASSERT_NEAR((position(mesh, found.surface) - found.point).norm(), 0, tolerance);
    ASSERT_NEAR((p - found.point).norm(), found.distance, tolerance);
  }
}

std::vector<Vec3> randomPoints(int count, double half, const Vec3& centre = Vec3::Zero()) {
  std::mt19937 random(11);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(centre + randomPoint(random, half));
  return points;
}

TEST(TriangleTree, AgreesWithBruteForceOnRandomPoints) {
  expectClosest(soup(500, 0.2, 1), randomPoints(500, 1.5), 1e-14);
  expectClosest(soup(300, 2, 2), randomPoints(300, 4), 1e-14); // large, crossing triangles
  expectClosest(torus(1, 0.3, 40, 20), randomPoints(300, 1.5), 1e-14);
}

TEST(TriangleTree, AgreesWithBruteForceOnVerticesAndFarAway) {
  const TriangleMesh mesh = icosphere(1, 6);
  expectClosest(mesh, mesh.positions, 1e-14);
  expectClosest(mesh, randomPoints(100, 1000), 1e-11);
  expectClosest(mesh, randomPoints(20, 1e9), 2e-2);
}

TEST(TriangleTree, AgreesWithBruteForceOnDegenerateTriangles) {
  expectClosest(degenerate(), randomPoints(500, 2.5), 1e-13);
  const Vec3 p(1, 2, 3);
  expectClosest(oneTriangle(p, p, p), randomPoints(20, 4), 1e-14);
  expectClosest(oneTriangle({0, 0, 0}, {1000, 0, 0}, {0, 1e-3, 0}),
                randomPoints(100, 3, {500, 0, 0}), 1e-10);
}

// Nodes that are not full, nodes that hold both nodes and triangles, a root without nodes.
TEST(TriangleTree, AgreesWithBruteForceForAnyNumberOfTriangles) {
  for (const int count : {1, 2, 7, 8, 9, 15, 16, 17, 63, 64, 65, 511, 513, 777, 1500})
    expectClosest(soup(count, 0.1, static_cast<unsigned>(count)), randomPoints(50, 1.5), 1e-14);
  TriangleMesh shrinking; // splits separate a few at a time
  for (int i = 0; i < 3000; ++i) {
    const double s = std::exp2(-0.01 * i);
    for (const Vec3& p : {Vec3(1, 0, 0), Vec3(1.02, 0.1, 0), Vec3(1, 0, 0.1)})
      shrinking.positions.push_back(s * p);
    shrinking.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  expectClosest(shrinking, randomPoints(50, 1), 1e-11); // up to there the small ones tie
}

TEST(TriangleTree, AgreesWithBruteForceAtAnySizeAndPosition) {
  for (const double scale : {1e-9, 1.0, 1e9}) {
    TriangleMesh mesh = soup(300, 0.2, 41);
    for (Vec3& p : mesh.positions) p *= scale;
    expectClosest(mesh, randomPoints(100, 1.5 * scale), 1e-14 * scale);
  }
  TriangleMesh moved = soup(300, 0.2, 42);
  const Vec3 offset(1e6, -1e6, 1e6);
  for (Vec3& p : moved.positions) p += offset;
  expectClosest(moved, randomPoints(100, 1.5, offset), 2e-9); // the oracle's own rounding
}

TEST(TriangleTree, AgreesWithBruteForceOnNeedles) {
  TriangleMesh mesh;
  std::mt19937 random(43);
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = randomPoint(random, 1), b = randomPoint(random, 1);
    const double width = std::pow(10.0, -i % 13);
    mesh = joined(mesh, oneTriangle(a, b, 0.5 * (a + b) + width * (b - a).unitOrthogonal()));
  }
  expectClosest(mesh, randomPoints(500, 1.5), 1e-12);
}

// Pairs of the same triangle, with opposite orientation and another first corner.
TEST(TriangleTree, TiesOfDuplicatesGoToTheLowestFaceForAnyWarmStart) {
  TriangleMesh mesh = soup(700, 0.1, 44);
  const std::size_t count = mesh.triangles.size();
  for (std::size_t i = count; i-- > 0;) {
    const auto [a, b, c] = mesh.triangles[i];
    mesh.triangles.push_back({b, a, c});
  }
  const TriangleTree tree(mesh);
  std::mt19937 random(45);
  std::uniform_int_distribution<std::int32_t> face(0, static_cast<std::int32_t>(2 * count) - 1);
  for (const Vec3& p : randomPoints(500, 1.2)) {
    const std::int32_t found = tree.closestPoint(p).surface.face;
    EXPECT_LT(found, static_cast<std::int32_t>(count));
    EXPECT_EQ(tree.closestPoint(p, face(random)).surface.face, found);
    EXPECT_EQ(tree.closestPoint(p, static_cast<std::int32_t>(2 * count) - 1 - found).surface.face,
              found);
  }
}

TEST(TriangleTree, HoldsAtMost300BytesATriangle) {
  const TriangleTree tree(icosphere(1, 79));
  EXPECT_LT(tree.bytes(), 300 * tree.size());
}

// A pile of identical boxes gives the builder no split.
TEST(TriangleTree, BuildsOverCoincidentTrianglesAndNamesTheLowest) {
  TriangleMesh mesh = oneTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.triangles.resize(1000, mesh.triangles[0]);
  const TriangleTree tree(mesh);
  EXPECT_EQ(tree.closestPoint({0.2, 0.2, 1}).surface.face, 0);
  EXPECT_EQ(tree.closestPoint({0.2, 0.2, 1}, 700).surface.face, 0);
  EXPECT_EQ(tree.facesInSphere({0.2, 0.2, 0}, 0.1).size(), 1000u);
}

// Copies in any order of their corners, of shared and of own vertices.
TEST(TriangleTree, ManyCopiesOfAFaceChangeNoAnswer) {
  const TriangleMesh once = icosphere(1, 4);
  const auto count = static_cast<std::int32_t>(once.triangles.size());
  TriangleMesh mesh = once;
  for (std::size_t i = 0; i < 3; ++i) mesh.positions.push_back(once.corner(7, static_cast<int>(i)));
  const auto own = static_cast<std::int32_t>(once.positions.size());
  Triangle shared = once.triangles[7], unshared = {own, own + 1, own + 2};
  for (int i = 0; i < 100; ++i) {
    mesh.triangles.push_back(shared);
    mesh.triangles.push_back(unshared);
    std::next_permutation(shared.begin(), shared.end());
    std::next_permutation(unshared.begin(), unshared.end());
  }
  const TriangleTree tree(once), copied(mesh);
  std::vector<Vec3> points = randomPoints(300, 1.5);
  for (int i = 0; i < 20; ++i) points.push_back(0.1 * i * (once.corner(7, 0) + once.corner(7, 1)));
  for (const Vec3& p : points) {
    const ClosestPoint one = tree.closestPoint(p), other = copied.closestPoint(p, count + 5);
    EXPECT_EQ(one.surface.face, other.surface.face);
    EXPECT_NEAR(one.distance, other.distance, 1e-12);
    std::vector<std::int32_t> faces = tree.facesInSphere(p, 0.5);
    if (std::find(faces.begin(), faces.end(), 7) != faces.end())
      for (std::int32_t copy = count; copy < count + 200; ++copy) faces.push_back(copy);
    EXPECT_EQ(copied.facesInSphere(p, 0.5), faces);
  }
}

TEST(TriangleTree, TiesGoToTheLowestFace) {
  const TriangleMesh mesh = icosphere(1, 4);
  const TriangleTree tree(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    std::int32_t lowest = -1;
    for (std::size_t i = mesh.triangles.size(); i-- > 0;)
      for (const std::int32_t corner : mesh.triangles[i])
        if (corner == static_cast<std::int32_t>(v)) lowest = static_cast<std::int32_t>(i);
    for (const double s : {1.0, 1.2, 3.0})
      EXPECT_EQ(tree.closestPoint(s * mesh.positions[v]).surface.face, lowest);
  }
}

TEST(TriangleTree, WarmStartChangesNothing) {
  const TriangleMesh mesh = torus(1, 0.4, 30, 15);
  const TriangleTree tree(mesh);
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int32_t> face(-2, 2000);
  for (const Vec3& p : randomPoints(300, 2)) {
    const ClosestPoint cold = tree.closestPoint(p);
    const ClosestPoint warm = tree.closestPoint(p, face(random));
    EXPECT_EQ(cold.surface.face, warm.surface.face);
    EXPECT_EQ(cold.distance, warm.distance);
    EXPECT_EQ(cold.point, warm.point);
  }
}

TEST(TriangleTree, FindsNothingBeyondTheGivenDistance) {
  const TriangleMesh mesh = soup(200, 0.2, 7);
  const TriangleTree tree(mesh);
  for (const Vec3& p : randomPoints(200, 2)) {
    const double d = bruteForce(mesh, p).distance;
    EXPECT_FALSE(tree.closestPointWithin(p, d * (1 - 1e-9)));
    const auto found = tree.closestPointWithin(p, d * (1 + 1e-9));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, d, 1e-14);
  }
}

TEST(TriangleTree, LosesNothingFarFromTheOrigin) {
  const TriangleMesh mesh = icosphere(0.05, 8);
  const Vec3 offset(5e4, -5e4, 5e4); // 1e6 sizes away
  TriangleMesh moved = mesh;
  for (Vec3& p : moved.positions) p += offset;
  const TriangleTree tree(moved);
  for (const Vec3& q : randomPoints(200, 0.1)) {
    const Vec3 p = q + offset; // rounds, as the mesh did
    ASSERT_NEAR(tree.closestPoint(p).distance, bruteForce(moved, p).distance, 1e-15);
  }
}

TEST(TriangleTree, FirstHitAgreesWithBruteForce) {
  const TriangleMesh mesh = soup(300, 0.3, 9);
  const TriangleTree tree(mesh);
  std::mt19937 random(10);
  int hits = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 origin = randomPoint(random, 2), direction = randomPoint(random, 1);
    const Vec3 unit = direction.normalized();
    double truth = 2;
    std::int32_t face = -1;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      Eigen::Matrix3d m;
      m << mesh.corner(k, 1) - mesh.corner(k, 0), mesh.corner(k, 2) - mesh.corner(k, 0), -unit;
      const Vec3 s = m.fullPivLu().solve(origin - mesh.corner(k, 0));
      if (s[0] >= 0 && s[1] >= 0 && s[0] + s[1] <= 1 && s[2] >= 0 && s[2] <= truth) {
        truth = s[2];
        face = static_cast<std::int32_t>(k);
      }
    }
    const auto hit = tree.firstHit(origin, direction, 2);
    ASSERT_EQ(hit.has_value(), face >= 0);
    if (!hit) continue;
    ++hits;
    EXPECT_EQ(hit->surface.face, face);
    EXPECT_NEAR(hit->t, truth, 1e-11);
    EXPECT_NEAR((position(mesh, hit->surface) - origin - hit->t * unit).norm(), 0, 1e-11);
  }
  EXPECT_GT(hits, 100);
}

TEST(TriangleTree, NoRaySlipsThroughAClosedMesh) {
  const TriangleMesh mesh = icosphere(1, 5);
  const TriangleTree tree(mesh);
  for (const Vec3& v : mesh.positions)
    EXPECT_TRUE(tree.firstHit(Vec3::Zero(), v, 2)); // through vertices
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    EXPECT_TRUE(tree.firstHit(Vec3::Zero(), mesh.corner(i, 0) + mesh.corner(i, 1), 2));
  const TriangleTree cube{box(Vec3(2, 2, 2))};
  const auto hit = cube.firstHit({0.3, 0.3, 5}, {0, 0, -1}, 10); // along the axes, on a diagonal
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t, 4, 1e-14);
  EXPECT_FALSE(cube.firstHit({0.3, 0.3, 5}, {0, 0, -1}, 3.99));
  EXPECT_FALSE(cube.firstHit({0.3, 0.3, 5}, {0, 0, 1}, 100));
}

TEST(TriangleTree, FacesInSphereAgreeWithBruteForce) {
  for (const TriangleMesh& mesh : {soup(400, 0.2, 21), soup(50, 3, 22), degenerate()}) {
    const TriangleTree tree(mesh);
    for (const Vec3& p : randomPoints(60, 1.5)) {
      for (const double radius : {0.0, 0.1, 0.7, 10.0}) {
        std::vector<std::int32_t> truth;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
          if (triangleDistance(p, mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)) <=
              radius)
            truth.push_back(static_cast<std::int32_t>(i));
        EXPECT_EQ(tree.facesInSphere(p, radius), truth);
      }
    }
  }
}

TEST(TriangleTree, RejectsEmptyAndNonFiniteMeshes) {
  EXPECT_THROW(TriangleTree{TriangleMesh{}}, std::invalid_argument);
  EXPECT_THROW(TriangleTree(oneTriangle({0, 0, 0}, {1, 0, 0}, {0, kInf, 0})),
               std::invalid_argument);
  const TriangleTree tree(icosphere(1, 2));
  const Vec3 nowhere(0, std::nan(""), 0);
  EXPECT_EQ(tree.closestPoint(nowhere).surface.face, -1);
  EXPECT_FALSE(tree.closestPointWithin(nowhere, 1));
  EXPECT_FALSE(tree.firstHit(Vec3::Zero(), Vec3::Zero(), 1));
  EXPECT_TRUE(tree.facesInSphere(nowhere, 1).empty());
}

// ---- The lattice query ----

void expectLatticeAgreement(const TriangleMesh& mesh, const Vec3& origin, double spacing,
                            double max_distance) {
  constexpr int kSide = 8;
  const TriangleTree tree(mesh);
  const double extent = bounds(mesh).sizes().maxCoeff();
  std::vector<float> distance(kSide * kSide * kSide);
  std::vector<std::int32_t> face(distance.size());
  tree.closestOnLattice(origin, spacing, kSide, max_distance, distance, face);
  for (int k = 0; k < kSide; ++k)
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) {
        const Vec3 p = origin + spacing * Vec3(i, j, k);
        const BruteForce truth = bruteForce(mesh, p);
        const auto at = static_cast<std::size_t>((k * kSide + j) * kSide + i);
        if (truth.distance > max_distance * (1 + 2e-5)) {
          ASSERT_EQ(face[at], -1);
          ASSERT_EQ(distance[at], std::numeric_limits<float>::infinity());
          continue;
        }
        if (truth.distance > max_distance) continue;
        const double tolerance = 4e-6 * truth.distance + 1e-7 * extent;
        ASSERT_GE(face[at], 0);
        ASSERT_NEAR(distance[at] * spacing, truth.distance, tolerance);
        const auto f = static_cast<std::size_t>(face[at]);
        ASSERT_NEAR(triangleDistance(p, mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)),
                    truth.distance, tolerance);
      }
}

TEST(TriangleTreeLattice, AgreesWithBruteForce) {
  expectLatticeAgreement(soup(500, 0.2, 31), Vec3::Constant(-1), 0.25, kInf);
  expectLatticeAgreement(soup(200, 2, 32), Vec3::Constant(-2), 0.5, 0.6);
  expectLatticeAgreement(torus(1, 0.3, 60, 30), {0.5, -0.2, 0.1}, 0.02, 0.1);
  expectLatticeAgreement(degenerate(), Vec3::Constant(-2), 0.51, kInf);
  expectLatticeAgreement(box(Vec3(1, 1, 1)), Vec3::Constant(-0.7), 0.2, kInf);
  expectLatticeAgreement(box(Vec3(1, 1e-3, 1)), Vec3::Constant(-0.1), 1e-3, 8e-3);
}

// Triangles of hundreds of spacings, where float would lose digits.
TEST(TriangleTreeLattice, KeepsItsDigitsNextToLargeTriangles) {
  const double h = 2.0 / 500;
  for (const Vec3& at : {Vec3(1, 1, 1), Vec3(0.3, 0.99, -1), Vec3(-1, -1.01, 0.2)})
    expectLatticeAgreement(box(Vec3(2, 2, 2)), at - Vec3::Constant(3.37 * h), h, 8 * h);
  expectLatticeAgreement(oneTriangle({-1, 0, 0}, {1, 1, 0}, {1, 1 + 1e-5, 1e-6}),
                         Vec3(0.5, 0.75, 0) - Vec3::Constant(3.37 * h), h, 8 * h);
}

TEST(TriangleTreeLattice, TiesGoToTheLowestFace) {
  TriangleMesh mesh = icosphere(1, 6);
  const std::size_t count = mesh.triangles.size();
  mesh.triangles.insert(mesh.triangles.end(), mesh.triangles.rbegin(), mesh.triangles.rend());
  const TriangleTree tree(mesh);
  std::vector<float> distance(512);
  std::vector<std::int32_t> face(512);
  tree.closestOnLattice(Vec3::Constant(-1.05), 0.3, 8, 10, distance, face);
  for (const std::int32_t f : face) EXPECT_LT(f, static_cast<std::int32_t>(count));
}

// Fine triangles and a coarse lattice are searched point by point, where float overflows.
TEST(TriangleTreeLattice, EndsForPointsBeyondFloat) {
  const TriangleTree tree(icosphere(1, 7)); // also indices without a triangle
  std::vector<float> distance(512);
  std::vector<std::int32_t> face(512);
  for (const double spacing : {1.0, 1e17, 1e25, 1e45}) {
    tree.closestOnLattice(Vec3::Constant(-spacing), spacing, 8, kInf, distance, face);
    for (const std::int32_t f : face) {
      EXPECT_LT(f, 980);
      EXPECT_TRUE(f >= 0 || spacing > 1e16);
    }
  }
}

TEST(TriangleTreeLattice, RefusesWrongSizes) {
  const TriangleTree tree(icosphere(1, 2));
  std::vector<float> distance(27);
  std::vector<std::int32_t> face(27);
  EXPECT_THROW(tree.closestOnLattice(Vec3::Zero(), 1, 3, 1, distance, face), std::invalid_argument);
  EXPECT_THROW(tree.closestOnLattice(Vec3::Zero(), 1, 4, 1, distance, face), std::invalid_argument);
}

} // namespace
} // namespace patina
