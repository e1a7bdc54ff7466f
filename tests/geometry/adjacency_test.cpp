// Neighbours against a brute-force table of all edges.
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "geometry/mesh/adjacency.h"
#include "geometry/mesh/shapes.h"
#include "support/mesh_defects.h"

namespace patina {
namespace {

bool repeatsVertex(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

std::vector<std::array<std::int32_t, 3>> neighboursByTable(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::int32_t>> faces_at;
  const auto edge = [&](std::size_t f, std::size_t k) {
    return std::minmax(mesh.triangles[f][k], mesh.triangles[f][(k + 1) % 3]);
  };
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3 && !repeatsVertex(mesh.triangles[f]); ++k)
      faces_at[edge(f, k)].push_back(static_cast<std::int32_t>(f));
  std::vector<std::array<std::int32_t, 3>> result(mesh.triangles.size(), {-1, -1, -1});
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3 && !repeatsVertex(mesh.triangles[f]); ++k) {
      const auto& faces = faces_at[edge(f, k)];
      if (faces.size() == 2)
        result[f][k] = faces[0] == static_cast<std::int32_t>(f) ? faces[1] : faces[0];
    }
  return result;
}

void expectAgreesWithTable(const TriangleMesh& mesh) {
  const Adjacency result = adjacency(mesh);
  EXPECT_EQ(result.face_neighbours, neighboursByTable(mesh));
  ASSERT_EQ(result.vertex_offsets.size(), mesh.positions.size() + 1);
  std::vector<std::vector<std::int32_t>> faces_of(mesh.positions.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (const std::int32_t v : mesh.triangles[f]) {
      auto& faces = faces_of[static_cast<std::size_t>(v)];
      if (faces.empty() || faces.back() != static_cast<std::int32_t>(f))
        faces.push_back(static_cast<std::int32_t>(f));
    }
  for (std::size_t v = 0; v < faces_of.size(); ++v)
    EXPECT_EQ(std::vector<std::int32_t>(result.vertex_faces.begin() + result.vertex_offsets[v],
                                        result.vertex_faces.begin() + result.vertex_offsets[v + 1]),
              faces_of[v]);
}

TEST(Adjacency, HasNoGapOnClosedShapes) {
  for (const TriangleMesh& mesh : {icosphere(1, 8), torus(1, 0.3, 20, 10), vase()}) {
    expectAgreesWithTable(mesh);
    for (const auto& neighbours : adjacency(mesh).face_neighbours)
      for (const std::int32_t other : neighbours) ASSERT_GE(other, 0);
  }
}

TEST(Adjacency, HandlesOpenFlippedCrackedAndNonManifoldMeshes) {
  expectAgreesWithTable(sheet(1, 1, 5));
  expectAgreesWithTable(galleon(0.3));
  expectAgreesWithTable(withFlippedFaces(icosphere(1, 12), 0.3, 5));
  expectAgreesWithTable(withHoles(icosphere(1, 12), 5, 0.2, 5));
  expectAgreesWithTable(withShrunkenTriangles(icosphere(1, 4), 0.1));
}

TEST(Adjacency, HandlesRandomTriangleSoupOverFewVertices) {
  std::mt19937 random(11);
  for (int round = 0; round < 20; ++round) {
    TriangleMesh mesh;
    mesh.positions.assign(12, Vec3::Zero());
    for (int t = 0; t < 40; ++t) {
      const auto vertex = [&] { return static_cast<std::int32_t>(random() % 12); };
      mesh.triangles.push_back({vertex(), vertex(), vertex()});
    }
    expectAgreesWithTable(mesh);
  }
}

TEST(Adjacency, SurfacesThatMeetInAVertexOnlyAreNotNeighbours) {
  TriangleMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  expectAgreesWithTable(mesh);
  EXPECT_EQ(adjacency(mesh).face_neighbours[0], (std::array<std::int32_t, 3>{-1, -1, -1}));
}

// A walk around such a hub for each face would take hours.
TEST(Adjacency, TakesLinearTimeForALargeFan) {
  constexpr std::int32_t kRim = 300000;
  TriangleMesh mesh;
  mesh.positions.assign(kRim + 1, Vec3::Zero());
  for (std::int32_t i = 0; i < kRim; ++i) mesh.triangles.push_back({kRim, i, (i + 1) % kRim});
  const Adjacency result = adjacency(mesh);
  EXPECT_EQ(result.face_neighbours[5], (std::array<std::int32_t, 3>{4, -1, 6}));
  EXPECT_EQ(result.vertex_offsets.back(), 3 * kRim);
}

TEST(Adjacency, CountsItsBytes) {
  const TriangleMesh mesh = icosphere(1, 10);
  EXPECT_GE(bytes(adjacency(mesh)), mesh.triangles.size() * 24 + mesh.positions.size() * 4);
}

} // namespace
} // namespace patina
