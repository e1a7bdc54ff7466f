// Shapes and mesh measures against closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/shapes.h"
#include "support/constants.h"
#include "support/mesh_defects.h"

namespace patina {
namespace {

using test::kPi;

TEST(Shapes, IcosphereHasTwentyFSquaredFacesOnTheSphere) {
  for (const int f : {1, 2, 7, 22}) {
    const TriangleMesh mesh = icosphere(0.05, f);
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(20 * f * f));
    EXPECT_EQ(mesh.positions.size(), static_cast<std::size_t>(10 * f * f + 2));
    for (const Vec3& p : mesh.positions) ASSERT_NEAR(p.norm(), 0.05, 1e-16);
    EXPECT_TRUE(inspect(mesh).watertight);
  }
}

TEST(Shapes, VolumeAndAreaConvergeWithTheSquareOfTheStep) {
  const auto sphere_error = [](int f) { return std::abs(volume(icosphere(1, f)) - 4 * kPi / 3); };
  EXPECT_NEAR(sphere_error(20) / sphere_error(40), 4, 0.1);
  const auto torus_error = [](int n) {
    return std::abs(volume(torus(1, 0.25, 4 * n, n)) - 2 * kPi * kPi * 0.0625);
  };
  EXPECT_NEAR(torus_error(20) / torus_error(40), 4, 0.1);
  const auto area_error = [](int n) {
    return std::abs(area(torus(1, 0.25, 4 * n, n)) - 4 * kPi * kPi * 0.25);
  };
  EXPECT_NEAR(area_error(20) / area_error(40), 4, 0.1);
}

TEST(Shapes, BoxAndSheetAreExact) {
  const TriangleMesh solid = box(Vec3(1, 2, 3), 4);
  EXPECT_EQ(solid.triangles.size(), 192u);
  EXPECT_NEAR(volume(solid), 6, 1e-13);
  EXPECT_NEAR(area(solid), 22, 1e-13);
  EXPECT_TRUE(bounds(solid).isApprox(Box3(Vec3(-0.5, -1, -1.5), Vec3(0.5, 1, 1.5))));
  const TriangleMesh flat = sheet(2, 3, 5);
  EXPECT_NEAR(area(flat), 6, 1e-13);
  EXPECT_EQ(faceNormal(flat, 17), Vec3(0, 0, 1));
}

TEST(Shapes, VaseIsAClosedThinWallOfThePublishedSize) {
  const TriangleMesh mesh = vase();
  EXPECT_EQ(mesh.triangles.size(), 4800u); // K25
  const MeshReport report = inspect(mesh);
  EXPECT_TRUE(report.watertight);
  EXPECT_EQ(report.degenerate, 0u);
  // For a wall of 4 mm the volume is close to half the area times the wall.
  EXPECT_GT(volume(mesh), 0);
  EXPECT_NEAR(volume(mesh) / (area(mesh) / 2 * 0.004), 1, 0.08);
  EXPECT_EQ(vase(0.1, 0.002, 30, 10).triangles.size(), 1200u);
}

TEST(Shapes, GalleonIsOpenNonManifoldAndOfThePublishedSize) {
  const TriangleMesh mesh = galleon(0.3);
  EXPECT_EQ(mesh.triangles.size(), 8794u); // K25
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.non_finite + report.degenerate + report.duplicate, 0u);
  EXPECT_GT(report.boundary_edges, 100u);
  EXPECT_EQ(report.non_manifold_edges, 181u); // both deck edges of 64, the keel of 53
  EXPECT_EQ(report.components, 14u);          // hull, 3 masts, 9 sails, bowsprit
  const Vec3 size = bounds(mesh).sizes();
  EXPECT_NEAR(size.x(), 0.3, 1e-12);
  EXPECT_EQ(size.maxCoeff(), size.x());
}

TEST(Shapes, ImpossibleSizesAreRefused) {
  EXPECT_THROW(icosphere(0, 3), std::invalid_argument);
  EXPECT_THROW(icosphere(1, 0), std::invalid_argument);
  EXPECT_THROW(torus(1, 2, 9, 9), std::invalid_argument);
  EXPECT_THROW(box(Vec3(1, 0, 1)), std::invalid_argument);
  EXPECT_THROW(vase(0.1, 0.02), std::invalid_argument);
  EXPECT_THROW(sheet(1, 1, 0), std::invalid_argument);
  EXPECT_THROW(galleon(std::nan("")), std::invalid_argument);
}

TEST(Defects, ShrunkTrianglesLoseTheirShareOfTheArea) {
  const TriangleMesh mesh = icosphere(1, 6);
  const TriangleMesh cracked = withShrunkenTriangles(mesh, 0.01);
  EXPECT_NEAR(area(cracked) / area(mesh), 0.99 * 0.99, 1e-12);
  // The report welds such near corners and states the width of the cracks.
  const MeshReport report = inspect(cracked);
  EXPECT_EQ(report.boundary_edges, 0u);
  EXPECT_GT(report.widest_crack, 0);
  EXPECT_LT((faceNormal(cracked, 40) - faceNormal(mesh, 40)).norm(), 1e-12);
}

TEST(Defects, FlippedFacesAreAboutTheirShareAndRepeatable) {
  const TriangleMesh mesh = icosphere(1, 30);
  const TriangleMesh flipped = withFlippedFaces(mesh, 0.05, 7);
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (flipped.triangles[t] != mesh.triangles[t]) ++count;
  EXPECT_NEAR(static_cast<double>(count) / static_cast<double>(mesh.triangles.size()), 0.05, 0.01);
  EXPECT_EQ(withFlippedFaces(mesh, 0.05, 7).triangles, flipped.triangles);
  EXPECT_NE(withFlippedFaces(mesh, 0.05, 8).triangles, flipped.triangles);
  EXPECT_EQ(withFlippedFaces(mesh, 0, 7).triangles, mesh.triangles);
  EXPECT_NEAR(volume(withFlippedFaces(mesh, 1, 7)), -volume(mesh), 1e-12);
}

TEST(Defects, HolesLeaveABoundaryAndNoUnusedVertex) {
  const TriangleMesh mesh = icosphere(1, 30);
  const TriangleMesh holed = withHoles(mesh, 12, 0.08, 3);
  EXPECT_LT(holed.triangles.size(), mesh.triangles.size());
  EXPECT_GT(inspect(holed).boundary_edges, 12u);
  std::vector<bool> used(holed.positions.size(), false);
  for (const Triangle& t : holed.triangles)
    for (const std::int32_t v : t) used[static_cast<std::size_t>(v)] = true;
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
  EXPECT_EQ(withHoles(mesh, 0, 0.08, 3).triangles.size(), mesh.triangles.size());
  // The smallest hole is the faces around one vertex.
  EXPECT_LE(withHoles(mesh, 1, 0, 3).triangles.size(), mesh.triangles.size() - 5);
}

TEST(TriangleMesh, BoundsAreOfUsedVerticesOnly) {
  TriangleMesh mesh = box(Vec3(1, 1, 1));
  mesh.positions.emplace_back(100, 0, 0);
  EXPECT_NEAR(bounds(mesh).sizes().x(), 1, 1e-15);
  EXPECT_TRUE(bounds({}).isEmpty());
}

TEST(TriangleMesh, MeasuresAreTheSameFarFromTheOrigin) {
  const TriangleMesh mesh = icosphere(1, 10);
  const TriangleMesh far = transformed(mesh, Eigen::Affine3d(Eigen::Translation3d(1e6, -1e6, 1e6)));
  EXPECT_NEAR(volume(far), volume(mesh), 1e-8);
  EXPECT_NEAR(area(far), area(mesh), 1e-8);
}

TEST(TriangleMesh, ReflectionKeepsTheOutsideOutside) {
  Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
  mirror.linear().diagonal() = Vec3(-2, 1, 1);
  const TriangleMesh mesh = icosphere(1, 5);
  EXPECT_NEAR(volume(transformed(mesh, mirror)), 2 * volume(mesh), 1e-12);
}

TEST(TriangleMesh, NormalsOfTinyAndDegenerateFacesAreFinite) {
  TriangleMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1e-180, 0, 0), Vec3(0, 1e-180, 0)};
  mesh.triangles = {{0, 1, 2}, {0, 1, 1}, {2, 2, 2}};
  EXPECT_EQ(faceNormal(mesh, 0), Vec3(0, 0, 1));
  EXPECT_EQ(faceNormal(mesh, 1), Vec3::Zero());
  EXPECT_EQ(faceNormal(mesh, 2), Vec3::Zero());
  EXPECT_EQ(position(mesh, {0, Vec3(0.5, 0.25, 0.25)}), Vec3(2.5e-181, 2.5e-181, 0));
}

TEST(TriangleMesh, JoinedHasTheTrianglesOfBoth) {
  const TriangleMesh a = icosphere(1, 2), b = box(Vec3(5, 5, 5));
  EXPECT_NEAR(volume(joined(a, b)), volume(a) + volume(b), 1e-12);
  EXPECT_EQ(joined({}, b).triangles, b.triangles);
  EXPECT_EQ(joined(a, {}).triangles, a.triangles);
}

} // namespace
} // namespace patina
