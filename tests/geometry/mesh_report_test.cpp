// Exact counts on meshes with known defects (the construction is the oracle).
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

struct Counts {
  std::size_t non_finite = 0, degenerate = 0, duplicate = 0;
  std::size_t boundary = 0, non_manifold = 0, misoriented = 0;
};

void expectCounts(const TriangleMesh& mesh, const Counts& counts) {
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.triangles, mesh.triangles.size());
  EXPECT_EQ(report.vertices, mesh.positions.size());
  EXPECT_EQ(report.non_finite, counts.non_finite);
  EXPECT_EQ(report.degenerate, counts.degenerate);
  EXPECT_EQ(report.duplicate, counts.duplicate);
  EXPECT_EQ(report.boundary_edges, counts.boundary);
  EXPECT_EQ(report.non_manifold_edges, counts.non_manifold);
  EXPECT_EQ(report.misoriented_edges, counts.misoriented);
}

TEST(MeshReport, ClosedShapesAreWatertight) {
  for (const TriangleMesh& mesh :
       {icosphere(1, 5), torus(1, 0.2, 9, 7), box(Vec3(1, 2, 3), 3), vase()}) {
    EXPECT_TRUE(inspect(mesh).watertight);
    EXPECT_EQ(inspect(mesh).components, 1u);
    expectCounts(mesh, {});
  }
}

TEST(MeshReport, CountsTheBoundaryOfASheet) {
  expectCounts(sheet(1, 1, 6), {.boundary = 24});
  EXPECT_FALSE(inspect(sheet(1, 1, 6)).watertight);
}

TEST(MeshReport, CountsOneRemovedTriangle) {
  TriangleMesh mesh = icosphere(1, 4);
  mesh.triangles.pop_back();
  expectCounts(mesh, {.boundary = 3});
}

TEST(MeshReport, CountsFlippedFaces) {
  TriangleMesh mesh = icosphere(1, 4);
  std::swap(mesh.triangles[7][1], mesh.triangles[7][2]);
  expectCounts(mesh, {.misoriented = 3});
  EXPECT_FALSE(inspect(mesh).watertight);
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  expectCounts(mesh, {.misoriented = 3});
}

TEST(MeshReport, InsideOutIsStillWatertight) {
  TriangleMesh mesh = icosphere(1, 4);
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  EXPECT_TRUE(inspect(mesh).watertight);
}

TEST(MeshReport, CountsAFinOnAnEdge) {
  TriangleMesh mesh = icosphere(1, 2);
  const Triangle t = mesh.triangles[0];
  mesh.positions.emplace_back(0, 0, 3);
  mesh.triangles.push_back({t[0], t[1], static_cast<std::int32_t>(mesh.positions.size()) - 1});
  expectCounts(mesh, {.boundary = 2, .non_manifold = 1});
}

TEST(MeshReport, CountsDuplicatesInAnyOrderAndOnlyTheLaterOnes) {
  TriangleMesh mesh = icosphere(1, 3);
  const Triangle t = mesh.triangles[10];
  mesh.triangles.push_back({t[1], t[2], t[0]});
  mesh.triangles.push_back({t[1], t[0], t[2]});
  mesh.triangles.push_back(mesh.triangles[11]);
  expectCounts(mesh, {.duplicate = 3});
  EXPECT_TRUE(inspect(mesh).watertight) << "edges are counted without the duplicates";
}

TEST(MeshReport, CountsNonFiniteFacesAndTheHoleTheyLeave) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    TriangleMesh mesh = icosphere(1, 4);
    mesh.positions.back()[1] = bad; // inside a face: six triangles around it
    expectCounts(mesh, {.non_finite = 6, .boundary = 6});
  }
}

TEST(MeshReport, ZeroAreaIsRelativeToTheLongestEdge) {
  TriangleMesh mesh;
  mesh.positions = {Vec3(0, 0, 0),      Vec3(1, 0, 0),       Vec3(0.5, 1e-13, 0),
                    Vec3(0.5, 1e-9, 0), Vec3(0.1, 0.1, 0.1), Vec3(0.3, 0.3, 0.3),
                    Vec3(0.7, 0.7, 0.7)};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {4, 5, 6}, {0, 0, 1}, {2, 2, 2}};
  EXPECT_EQ(inspect(mesh).degenerate, 4u);
  for (const double scale : {1e-200, 1e-30, 1e30, 1e200}) {
    TriangleMesh scaled = mesh;
    for (Vec3& p : scaled.positions) p *= scale;
    EXPECT_EQ(inspect(scaled).degenerate, 4u) << scale;
  }
}

TEST(MeshReport, EqualPositionsMakeADegenerateTriangle) {
  TriangleMesh mesh = box(Vec3(1, 1, 1));
  mesh.positions.push_back(mesh.positions[0]);
  mesh.triangles.push_back({0, 1, static_cast<std::int32_t>(mesh.positions.size()) - 1});
  expectCounts(mesh, {.degenerate = 1});
}

TEST(MeshReport, ComponentsAreConnectedThroughVertices) {
  const TriangleMesh one = icosphere(1, 2);
  const auto moved = [&](double x) {
    return transformed(one, Eigen::Affine3d(Eigen::Translation3d(x, 0, 0)));
  };
  TriangleMesh mesh = joined(joined(one, moved(3)), moved(6));
  EXPECT_EQ(inspect(mesh).components, 3u);
  mesh.triangles.push_back({0, static_cast<std::int32_t>(one.positions.size()),
                            static_cast<std::int32_t>(one.positions.size()) + 2});
  EXPECT_EQ(inspect(mesh).components, 2u);
  EXPECT_EQ(inspect(withShrunkenTriangles(one, 0.1)).components, one.triangles.size());
}

TriangleMesh jittered(TriangleMesh mesh, double most) {
  std::mt19937 random(3);
  for (Vec3& p : mesh.positions)
    for (int k = 0; k < 3; ++k) p[k] += most * (static_cast<double>(random()) / 4294967296.0 - 0.5);
  return mesh;
}

TEST(MeshReport, WeldsCornersThatAreDuplicatedPerFace) {
  for (const TriangleMesh& mesh : {icosphere(1, 5), torus(1, 0.2, 9, 7), box(Vec3(1, 2, 3), 3)}) {
    const TriangleMesh soup = withShrunkenTriangles(mesh, 0);
    EXPECT_TRUE(inspect(soup).watertight);
    EXPECT_EQ(inspect(soup).components, 1u);
    EXPECT_EQ(inspect(soup).widest_crack, 0);
    expectCounts(soup, {});
  }
  expectCounts(withShrunkenTriangles(sheet(1, 1, 6), 0), {.boundary = 24});
  TriangleMesh open = withShrunkenTriangles(icosphere(1, 4), 0);
  open.triangles.pop_back();
  expectCounts(open, {.boundary = 3});
}

TEST(MeshReport, SeparatesBodiesWithCornersDuplicatedPerFace) {
  const TriangleMesh soup = withShrunkenTriangles(icosphere(1, 3), 0);
  const TriangleMesh two =
      joined(soup, transformed(soup, Eigen::Affine3d(Eigen::Translation3d(2.5, 0, 0))));
  EXPECT_EQ(inspect(two).components, 2u);
  EXPECT_TRUE(inspect(two).watertight);
  EXPECT_EQ(inspect(joined(soup, soup)).duplicate, soup.triangles.size());
  EXPECT_TRUE(inspect(joined(soup, soup)).watertight);
}

TEST(MeshReport, ClosesCracksAndReportsTheWidest) {
  for (const double scale : {1e-3, 1.0, 1e6})
    for (const TriangleMesh& shape : {icosphere(1, 6), torus(1, 0.3, 24, 12), box(Vec3(1, 2, 3))}) {
      const TriangleMesh mesh = transformed(shape, Eigen::Affine3d(Eigen::Scaling(scale)));
      const double size = bounds(mesh).sizes().maxCoeff();
      for (const double share : {1e-7, 1e-5, 3e-4}) {
        const TriangleMesh cracked = jittered(withShrunkenTriangles(mesh, 0), share * size);
        const MeshReport report = inspect(cracked);
        EXPECT_TRUE(report.watertight) << share;
        EXPECT_EQ(report.components, 1u);
        EXPECT_GT(report.widest_crack, 0.3 * share * size);
        EXPECT_LT(report.widest_crack, 1.75 * share * size);
      }
      const MeshReport wide = inspect(jittered(withShrunkenTriangles(mesh, 0), 0.02 * size));
      EXPECT_FALSE(wide.watertight);
    }
}

TEST(MeshReport, DoesNotWeldTheEndsOfShortEdges) {
  TriangleMesh mesh = sheet(1, 1, 2);
  const auto first = static_cast<std::int32_t>(mesh.positions.size());
  for (const Vec3& p : {Vec3(5, 0, 0), Vec3(5.0001, 0, 0), Vec3(5, 0.0001, 0)})
    mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  expectCounts(mesh, {.boundary = 11});
  EXPECT_EQ(inspect(mesh).widest_crack, 0);
}

TEST(MeshReport, CornerOnAnEdgeOfAnotherFaceClosesTheEdge) {
  // A box whose top is one pair of triangles, while a side has a corner on that edge.
  TriangleMesh mesh = box(Vec3(1, 1, 1));
  const Triangle cut = mesh.triangles[0];
  const Vec3 middle = (mesh.corner(0, 0) + mesh.corner(0, 1)) / 2;
  const auto v = static_cast<std::int32_t>(mesh.positions.size());
  mesh.positions.push_back(middle);
  mesh.triangles[0] = {cut[0], v, cut[2]};
  mesh.triangles.push_back({v, cut[1], cut[2]});
  expectCounts(mesh, {});
  EXPECT_TRUE(inspect(mesh).watertight);
  mesh.triangles.push_back({cut[0], v, cut[1]}); // changes nothing, like a triangle without area
  expectCounts(mesh, {.degenerate = 1});
  EXPECT_TRUE(inspect(mesh).watertight);
  EXPECT_TRUE(inspect(withShrunkenTriangles(mesh, 0)).watertight);
}

TEST(MeshReport, SidesOfOneBoxThatAreDividedDifferentlyAreClosed) {
  TriangleMesh mesh;
  int parts = 1;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Quaterniond turned =
          Eigen::Quaterniond::FromTwoVectors(Vec3(0, 0, 1), side * axis);
      Eigen::Affine3d placed = Eigen::Affine3d::Identity();
      placed.linear() = turned.toRotationMatrix().array().round().matrix();
      placed.translation() = side * axis;
      append(mesh, transformed(sheet(2, 2, parts++), placed));
    }
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.boundary_edges, 0u);
  EXPECT_TRUE(report.watertight);
  EXPECT_EQ(report.components, 1u);
}

TEST(MeshReport, EmptyMeshIsNotWatertight) {
  EXPECT_FALSE(inspect({}).watertight);
  EXPECT_EQ(inspect({}).components, 0u);
}

TEST(Cleaned, DropsAndReportsUnusableTriangles) {
  TriangleMesh mesh = icosphere(1, 4);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto u = static_cast<double>(t);
    mesh.corner_uvs.push_back({Vec2(u, 0), Vec2(u, 1), Vec2(u, 2)});
  }
  const Vec3 last = mesh.positions.back();
  mesh.positions.insert(mesh.positions.begin(), Vec3(std::nan(""), 0, 0)); // unused
  for (Triangle& t : mesh.triangles)
    for (std::int32_t& v : t) ++v;
  mesh.triangles.insert(mesh.triangles.begin(), {{1, 1, 2}, {0, 1, 2}});
  mesh.corner_uvs.insert(mesh.corner_uvs.begin(), 2, {});
  mesh.triangles.push_back(mesh.triangles.back()); // a duplicate stays
  mesh.corner_uvs.push_back(mesh.corner_uvs.back());

  const CleanMesh clean = cleaned(mesh);
  EXPECT_EQ(clean.dropped, 2u);
  EXPECT_EQ(clean.report.non_finite, 1u);
  EXPECT_EQ(clean.report.degenerate, 1u);
  EXPECT_EQ(clean.report.duplicate, 1u);
  EXPECT_EQ(clean.report.triangles, mesh.triangles.size());
  EXPECT_EQ(clean.mesh.triangles.size(), mesh.triangles.size() - 2);
  EXPECT_EQ(clean.mesh.positions.size(), icosphere(1, 4).positions.size());
  EXPECT_EQ(clean.mesh.positions.back(), last);
  ASSERT_EQ(clean.mesh.corner_uvs.size(), clean.mesh.triangles.size());
  EXPECT_EQ(clean.mesh.corner_uvs[5][2], Vec2(5, 2));
  for (std::size_t t = 0; t < clean.mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) ASSERT_EQ(clean.mesh.corner(t, k), mesh.corner(t + 2, k));
}

TEST(Cleaned, KeepsAValidMeshUnchanged) {
  const TriangleMesh mesh = vase();
  const CleanMesh clean = cleaned(mesh);
  EXPECT_EQ(clean.dropped, 0u);
  EXPECT_EQ(clean.mesh.positions, mesh.positions);
  EXPECT_EQ(clean.mesh.triangles, mesh.triangles);
}

TEST(Cleaned, RefusesAMeshWithNothingLeft) {
  EXPECT_THROW(cleaned({}), Error);
  TriangleMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THROW(cleaned(mesh), Error);
}

} // namespace
} // namespace patina
