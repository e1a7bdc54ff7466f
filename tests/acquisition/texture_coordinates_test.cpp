// Texture coordinates along a path over a mesh (A12 to A16), against closed forms on planes and
// circles.
#include "acquisition/texture/texture_coordinates.h"

#include <map>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/acquisition/registration_shapes.h"

namespace patina {
namespace {

using test::Draw;

std::vector<std::int32_t> allFaces(const TriangleMesh& mesh) {
  std::vector<std::int32_t> all(mesh.triangles.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int32_t>(i);
  return all;
}

// A sheet whose inner corners are moved within its plane.
TriangleMesh unevenSheet(double side, int cells, unsigned seed) {
  TriangleMesh mesh = sheet(side, side, cells);
  Draw draw(seed);
  const double most = 0.3 * side / cells;
  for (Vec3& p : mesh.positions)
    if (std::abs(p.x()) < 0.499 * side && std::abs(p.y()) < 0.499 * side)
      p += Vec3(draw.uniform(-most, most), draw.uniform(-most, most), 0);
  return mesh;
}

// Length of the segment a..b inside a triangle of the plane z = 0, clipped edge by edge.
double lengthWithin(const TriangleMesh& mesh, std::size_t face, const Vec3& a, const Vec3& b) {
  double from = 0, to = 1;
  for (int k = 0; k < 3; ++k) {
    const Vec3 p = mesh.corner(face, k), edge = mesh.corner(face, (k + 1) % 3) - p;
    const double at_a = edge.cross(a - p).z(), at_b = edge.cross(b - p).z();
    if (at_a < 0 && at_b < 0) return 0;
    if (at_a < 0) from = std::max(from, at_a / (at_a - at_b));
    if (at_b < 0) to = std::min(to, at_a / (at_a - at_b));
  }
  return std::max(0.0, to - from) * (b - a).norm();
}

TEST(FacesUnder, IncludeFacesCrossedBetweenSamples) {
  Draw draw(4);
  for (unsigned seed = 0; seed < 20; ++seed) {
    const MeshQuery ground(unevenSheet(0.1, 30, seed));
    std::vector<Vec3> path;
    for (int i = 0; i < 5; ++i)
      path.emplace_back(draw.uniform(-0.05, 0.05), draw.uniform(-0.05, 0.05), 0);
    std::vector<std::int32_t> crossed;
    for (const std::int32_t face : allFaces(ground.mesh)) {
      double length = 0;
      for (std::size_t i = 0; i + 1 < path.size(); ++i)
        length += lengthWithin(ground.mesh, static_cast<std::size_t>(face), path[i], path[i + 1]);
      if (length > 1e-6) crossed.push_back(face);
    }
    const std::vector<std::int32_t> found = facesUnder(ground, path);
    std::vector<std::int32_t> missed;
    std::set_difference(crossed.begin(), crossed.end(), found.begin(), found.end(),
                        std::back_inserter(missed));
    EXPECT_TRUE(missed.empty()) << "seed " << seed << ": " << missed.size() << " of "
                                << crossed.size();
    EXPECT_LE(found.size(), crossed.size() + 6); // corners that it only touches
  }
}

// T-A13
TEST(Rings, CountNeighboursByVertexOrByEdge) {
  const MeshQuery ground(sheet(0.1, 0.1, 10));
  const Vec3 inside = (ground.mesh.corner(90, 0) + ground.mesh.corner(90, 1) * 1.1 +
                       ground.mesh.corner(90, 2) * 0.9) /
                      3;
  const std::vector<std::int32_t> under = facesUnder(ground, {inside, inside});
  ASSERT_EQ(under, std::vector<std::int32_t>{90});
  EXPECT_EQ(withRings(ground, under, 0).size(), 1u);
  EXPECT_EQ(withRings(ground, under, 1).size(), 13u);
  EXPECT_EQ(withRings(ground, under, 1, Neighbours::by_edge).size(), 4u);
  EXPECT_EQ(withRings(ground, under, 100).size(), ground.mesh.triangles.size());
}

// T-A14a
TEST(PathCoordinates, MatchThePlaneForAStraightPath) {
  const MeshQuery ground(unevenSheet(0.1, 20, 7));
  const Vec3 from(-0.031, -0.017, 0), to(0.022, 0.025, 0), along = (to - from).normalized(),
                                                           left = Vec3::UnitZ().cross(along);
  std::vector<Vec3> path;
  for (int i = 0; i <= 37; ++i) path.push_back(from + (to - from) * (i / 37.0));
  path.insert(path.begin() + 5, path[5]); // one that repeats
  const PathCoordinates found = pathCoordinates(ground, allFaces(ground.mesh), {path, {}}, {});
  EXPECT_EQ(found.faces.size(), ground.mesh.triangles.size());
  EXPECT_NEAR(found.length, (to - from).norm(), 1e-12);
  EXPECT_NEAR(found.max_stretch, 1, 1e-9);
  for (const TexturedFace& face : found.faces)
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = ground.mesh.corner(static_cast<std::size_t>(face.face), k) - from;
      EXPECT_NEAR(face.coords[static_cast<std::size_t>(k)].x(), p.dot(along), 1e-12);
      EXPECT_NEAR(face.coords[static_cast<std::size_t>(k)].y(), p.dot(left), 1e-12);
    }
}

std::vector<Vec3> circle(double radius, int n) {
  std::vector<Vec3> path;
  for (int i = 0; i <= n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    path.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return path;
}

// T-A14b
TEST(PathCoordinates, ConvergeLikeTheChordsOfACircle) {
  const double radius = 0.03;
  const MeshQuery ground(unevenSheet(0.1, 40, 2));
  std::vector<std::int32_t> near;
  for (const std::int32_t face : allFaces(ground.mesh)) {
    bool is = true;
    for (int k = 0; k < 3; ++k) {
      const double r = ground.mesh.corner(static_cast<std::size_t>(face), k).norm();
      is = is && r > 0.015 && r < 0.045;
    }
    if (is) near.push_back(face);
  }
  std::vector<double> errors;
  for (const int n : {64, 128, 256, 512}) {
    const PathCoordinates found = pathCoordinates(ground, near, {circle(radius, n), {}}, {});
    EXPECT_EQ(found.faces.size(), near.size());
    const double length = found.length;
    double most = 0;
    for (const TexturedFace& face : found.faces)
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = ground.mesh.corner(static_cast<std::size_t>(face.face), k);
        double x = radius * std::atan2(p.y(), p.x()) - face.coords[static_cast<std::size_t>(k)].x();
        x -= length * std::round(x / length); // a closed path has a seam
        // The path runs counter-clockwise around +z, so the centre is to the left.
        const double y = radius - p.head<2>().norm() - face.coords[static_cast<std::size_t>(k)].y();
        EXPECT_LE(std::abs(y), 1.0001 * radius * (1 - std::cos(std::numbers::pi / n)));
        most = std::max({most, std::abs(x), std::abs(y)});
      }
    errors.push_back(most);
  }
  for (std::size_t i = 0; i + 1 < errors.size(); ++i)
    EXPECT_GT(std::log2(errors[i] / errors[i + 1]), 1.8) << errors[i] << " " << errors[i + 1];
}

// T-A14c, T-A14d
TEST(PathCoordinates, ReverseWithThePathAndMoveWithTheMesh) {
  const TriangleMesh mesh = test::bumpyPatch(60);
  const MeshQuery ground(mesh);
  std::vector<Vec3> path;
  for (int i = 0; i <= 60; ++i) {
    const Vec3 p(-0.03 + 0.001 * i, 0.01 * std::sin(0.05 * i), 0);
    path.push_back(ground.tree.closestPoint(p).point);
  }
  const auto faces = withRings(ground, facesUnder(ground, path), 2);
  const PathCoordinates found = pathCoordinates(ground, faces, {path, {}}, {3});
  ASSERT_GT(found.faces.size(), 150u);

  const PathCoordinates back =
      pathCoordinates(ground, faces, {{path.rbegin(), path.rend()}, {}}, {3});
  ASSERT_EQ(back.faces.size(), found.faces.size());
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(1.1, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  pose.translation() = Vec3(0.2, -0.1, 0.5);
  std::vector<Vec3> moved;
  for (const Vec3& p : path) moved.push_back(pose * p);
  const MeshQuery elsewhere(transformed(mesh, Eigen::Affine3d(pose)));
  const PathCoordinates there = pathCoordinates(elsewhere, faces, {moved, {}}, {3});
  ASSERT_EQ(there.faces.size(), found.faces.size());
  for (std::size_t i = 0; i < found.faces.size(); ++i) {
    EXPECT_EQ(found.faces[i].texture, 3);
    EXPECT_EQ(there.faces[i].face, found.faces[i].face);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 &at = found.faces[i].coords[k], &turned = back.faces[i].coords[k];
      EXPECT_NEAR(turned.x(), found.length - at.x(), 1e-12);
      EXPECT_NEAR(turned.y(), -at.y(), 1e-12);
      EXPECT_LT((there.faces[i].coords[k] - at).norm(), 1e-12);
    }
  }
}

TEST(PathCoordinates, HaveASeamWithoutWarpBetweenTwoLegs) {
  const MeshQuery ground(unevenSheet(0.1, 50, 5));
  std::vector<Vec3> path; // up one side, round a half circle of 10 mm, down the other
  for (int i = 0; i <= 40; ++i) path.emplace_back(-0.01, -0.04 + 0.001 * i, 0);
  for (int i = 1; i < 40; ++i) {
    const double angle = std::numbers::pi * (1 - i / 40.0);
    path.emplace_back(0.01 * std::cos(angle), 0.01 * std::sin(angle), 0);
  }
  for (int i = 40; i >= 0; --i) path.emplace_back(0.01, -0.04 + 0.001 * i, 0);
  const auto all = allFaces(ground.mesh);
  const PathCoordinates found = pathCoordinates(ground, all, {path, {}}, {});
  EXPECT_EQ(found.faces.size() + found.folded + found.ambiguous + found.stretched, all.size());
  EXPECT_GT(found.faces.size(), 0.95 * static_cast<double>(all.size()));
  std::size_t legs = 0;
  for (const TexturedFace& face : found.faces) {
    const auto f = static_cast<std::size_t>(face.face);
    const Vec3 middle =
        (ground.mesh.corner(f, 0) + ground.mesh.corner(f, 1) + ground.mesh.corner(f, 2)) / 3;
    if (middle.y() > -0.005) continue;
    const double side = middle.x() < 0 ? -1 : 1; // sign of the nearer leg
    ++legs;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = ground.mesh.corner(f, k);
      const double way = p.y() + 0.04, x = side < 0 ? way : found.length - way;
      EXPECT_NEAR(face.coords[static_cast<std::size_t>(k)].x(), x, 1e-9);
      EXPECT_NEAR(face.coords[static_cast<std::size_t>(k)].y(),
                  side < 0 ? -0.01 - p.x() : p.x() - 0.01, 1e-9);
    }
  }
  EXPECT_GT(legs, 1500u);
}

TEST(PathCoordinates, OmitFoldsOfABendAndReportThem) {
  const MeshQuery ground(unevenSheet(0.1, 100, 9));
  // A half circle of 5 mm whose legs end at once: behind its centre x runs backwards.
  std::vector<Vec3> path;
  for (int i = 0; i <= 60; ++i) {
    const double angle = std::numbers::pi * i / 60.0;
    path.emplace_back(0.005 * std::cos(angle), 0.005 * std::sin(angle), 0);
  }
  const auto all = allFaces(ground.mesh);
  const PathCoordinates found = pathCoordinates(ground, all, {path, {}}, {});
  EXPECT_GT(found.folded + found.ambiguous + found.stretched, 4u);
  for (const TexturedFace& face : found.faces) {
    const auto f = static_cast<std::size_t>(face.face);
    const Vec2 a = face.coords[1] - face.coords[0], b = face.coords[2] - face.coords[0];
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0) << f;
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = ground.mesh.corner(f, (k + 1) % 3) - ground.mesh.corner(f, k);
      const Vec2 grown = face.coords[static_cast<std::size_t>((k + 1) % 3)] -
                         face.coords[static_cast<std::size_t>(k)];
      EXPECT_LE(grown.norm(), 2.0001 * edge.norm());
    }
  }
}

// T-A17: equal paths on two meshes of one surface give equal coordinates at any point.
TEST(PathCoordinates, DoNotDependOnTheTriangles) {
  const std::vector<Vec3> path = {{-0.04, -0.01, 0}, {0.04, 0.012, 0}};
  const auto coordinateAt = [&](const MeshQuery& ground, const PathCoordinates& found,
                                const Vec3& p) {
    const SurfacePoint at = ground.tree.closestPoint(p).surface;
    const TexturedFace& face = found.faces[static_cast<std::size_t>(at.face)];
    return Vec2(at.barycentric[0] * face.coords[0] + at.barycentric[1] * face.coords[1] +
                at.barycentric[2] * face.coords[2]);
  };
  const MeshQuery coarse(unevenSheet(0.1, 7, 1)), fine(unevenSheet(0.1, 90, 2));
  const PathCoordinates a = pathCoordinates(coarse, allFaces(coarse.mesh), {path, {}}, {});
  const PathCoordinates b = pathCoordinates(fine, allFaces(fine.mesh), {path, {}}, {});
  Draw draw(6);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p(draw.uniform(-0.05, 0.05), draw.uniform(-0.05, 0.05), 0);
    EXPECT_LT((coordinateAt(coarse, a, p) - coordinateAt(fine, b, p)).norm(), 1e-12);
  }
}

// The path is closed, and its two directions at the beginning are opposite.
TEST(PathCoordinates, AreFiniteForAPathThereAndBack) {
  const MeshQuery ground(sheet(0.1, 0.1, 10));
  const std::vector<Vec3> path = {{0, 0, 0}, {0.02, 0, 0}, {0.04, 0, 0}, {0.02, 0, 0}, {0, 0, 0}};
  for (const TexturedFace& face :
       pathCoordinates(ground, allFaces(ground.mesh), {path, {}}, {}).faces)
    for (const Vec2& at : face.coords) EXPECT_TRUE(at.allFinite());
}

TEST(PathCoordinates, NeedAPathWithLength) {
  const MeshQuery ground(sheet(0.1, 0.1, 4));
  EXPECT_THROW(pathCoordinates(ground, {0}, {{Vec3::Zero(), Vec3::Zero()}, {}}, {}), Error);
  EXPECT_THROW(pathCoordinates(ground, {0}, {}, {}), Error);
}

} // namespace
} // namespace patina
