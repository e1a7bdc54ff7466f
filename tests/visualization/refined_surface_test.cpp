#include "visualization/surfaces/refined_surface.h"

#include <map>

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

double longestEdge(const TriangleMesh& mesh) {
  double longest = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (mesh.corner(f, k) - mesh.corner(f, (k + 1) % 3)).norm());
  return longest;
}

TEST(RefinedSurface, KeepsTheSurfaceInSmallEnoughTriangles) {
  const TriangleMesh coarse = box(Vec3(0.1, 0.04, 0.002), 1);
  const RefinedSurface fine = refined(coarse, 0.003);
  EXPECT_LE(longestEdge(fine.mesh), 0.003);
  EXPECT_NEAR(area(fine.mesh), area(coarse), 1e-12);
  EXPECT_NEAR(volume(fine.mesh), volume(coarse), 1e-15);
  ASSERT_EQ(fine.parent.size(), fine.mesh.triangles.size());
  for (std::size_t t = 0; t < fine.parent.size(); ++t)
    ASSERT_LT(
        (faceNormal(fine.mesh, t) - faceNormal(coarse, static_cast<std::size_t>(fine.parent[t])))
            .norm(),
        1e-12);
}

// A crack would be an edge with one face.
TEST(RefinedSurface, StaysClosed) {
  for (const TriangleMesh& coarse : {icosphere(0.05, 2), vase(), torus(0.04, 0.01, 7, 5)}) {
    const RefinedSurface fine = refined(coarse, 0.004);
    std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
    for (const Triangle& t : fine.mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1);
      ASSERT_TRUE(edges.contains({edge.second, edge.first}));
    }
  }
}

TEST(RefinedSurface, TextureCoordinatesAndNormalsMatchTheCoarseFaces) {
  TriangleMesh coarse = sheet(0.1, 0.06, 1);
  for (std::size_t f = 0; f < coarse.triangles.size(); ++f) {
    std::array<Vec2, 3> uv;
    for (int k = 0; k < 3; ++k)
      uv[static_cast<std::size_t>(k)] = Vec2(3 * coarse.corner(f, k).x(), coarse.corner(f, k).y());
    coarse.corner_uvs.push_back(uv);
  }
  const RefinedSurface fine = refined(coarse, 0.004);
  for (std::size_t f = 0; f < fine.mesh.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = fine.mesh.corner(f, k);
      const auto at = static_cast<std::size_t>(k);
      ASSERT_LT((fine.mesh.corner_uvs[f][at] - Vec2(3 * p.x(), p.y())).norm(), 1e-12);
      ASSERT_LT((fine.normals[f][at].normalized() - Vec3::UnitZ()).norm(), 1e-12);
    }
}

TEST(RefinedSurface, IsBoundedForEveryRequest) {
  EXPECT_LT(refined(box(Vec3(1, 1, 1), 1), 1e-6, 10'000).mesh.triangles.size(), 25'000U);
  TriangleMesh needle;
  needle.positions = {Vec3::Zero(), Vec3(1000, 0, 0), Vec3(500, 1e-9, 0)};
  needle.triangles = {{0, 1, 2}};
  EXPECT_LT(refined(needle, 1e-6, 10'000).mesh.triangles.size(), 50'000U);
  const TriangleMesh dense = icosphere(0.05, 60);
  EXPECT_EQ(refined(dense, 0.01, 100).mesh.triangles.size(), dense.triangles.size());
  EXPECT_THROW(refined(dense, 0), std::invalid_argument);
  EXPECT_THROW(refined(dense, NAN), std::invalid_argument);
}

TEST(RefinedSurface, LeavesOutNonFiniteTriangles) {
  TriangleMesh mesh = sheet(0.1, 0.1, 2);
  mesh.positions[0].x() = NAN;
  EXPECT_LT(refined(mesh, 1).mesh.triangles.size(), mesh.triangles.size());
  EXPECT_TRUE(refined(TriangleMesh{}, 1).mesh.triangles.empty());
}

} // namespace
} // namespace patina
