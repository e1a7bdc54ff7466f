#include "field/surface/iso_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "field/analytic_fields.h"
#include "field/surface/models.h"

namespace patina {
namespace {

using namespace test;

struct Topology {
  bool closed_manifold = true; // each directed edge once, with its opposite
  long euler = 0;
  std::size_t components = 0;
};

Topology topologyOf(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> edges, opposite;
  std::vector<int> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto up = [&](int v) -> int& { return parent[static_cast<std::size_t>(v)]; };
  const auto root = [&](int v) {
    while (up(v) != v) v = up(v) = up(up(v));
    return v;
  };
  for (const Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const int a = t[c], b = t[(c + 1) % 3];
      edges.emplace_back(a, b);
      opposite.emplace_back(b, a);
      up(root(a)) = root(b);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(opposite.begin(), opposite.end());
  Topology result;
  result.closed_manifold =
      edges == opposite && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
  result.euler = static_cast<long>(mesh.positions.size()) - static_cast<long>(edges.size() / 2) +
                 static_cast<long>(mesh.triangles.size());
  for (std::size_t v = 0; v < parent.size(); ++v)
    result.components += parent[v] == static_cast<int>(v);
  return result;
}

TEST(IsoCases, EveryPatternClosesToLoopsThatCrossAllItsEdgesOnce) {
  for (unsigned inside = 0; inside < 256; ++inside) {
    std::multiset<int> crossed;
    for (const auto& loop : isoLoops(inside)) {
      EXPECT_GE(loop.size(), 3U);
      crossed.insert(loop.begin(), loop.end());
    }
    for (int e = 0; e < kCellEdges; ++e) {
      const CellEdge& edge = kCellEdge[static_cast<std::size_t>(e)];
      const int low = edge.x + 2 * edge.y + 4 * edge.z, high = low + (1 << edge.axis);
      const bool changes = (inside >> low & 1U) != (inside >> high & 1U);
      EXPECT_EQ(crossed.count(e), changes ? 1U : 0U) << inside;
    }
  }
}

// A diagonal in a cell face could meet the neighbour's and join four triangles at one edge.
TEST(IsoCases, NoDiagonalLiesInAFaceOfTheCell) {
  for (const MarchingCubesCase& c : marchingCubesCases())
    for (std::size_t t = 0; t < c.count; ++t)
      for (std::size_t u = t + 1; u < c.count; ++u)
        for (std::size_t a = 0; a < 3; ++a)
          for (std::size_t b = 0; b < 3; ++b) {
            const bool shared = c.triangle[t][a] == c.triangle[u][(b + 1) % 3] &&
                                c.triangle[t][(a + 1) % 3] == c.triangle[u][b];
            EXPECT_FALSE(shared && shareFace(c.triangle[t][a], c.triangle[u][b]));
          }
}

TEST(IsoSurface, IsClosedOutwardAndSecondOrderOnASphere) {
  const double radius = 0.05;
  double area_error[2], volume_error[2];
  for (int level = 0; level < 2; ++level) {
    const FieldGrid grid = cubeGrid(radius, (40 << level) + 16);
    const SurfaceField field = sampleFunction(sphereDistance(radius), grid, 8);
    const TriangleMesh mesh = isoSurface(field, 0);
    const Topology topology = topologyOf(mesh);
    EXPECT_TRUE(topology.closed_manifold);
    EXPECT_EQ(topology.euler, 2);
    EXPECT_EQ(topology.components, 1U);
    area_error[level] = 1 - area(mesh) / (4 * M_PI * radius * radius);
    volume_error[level] = 1 - volume(mesh) / (4 * M_PI * radius * radius * radius / 3);
    EXPECT_GT(volume(mesh), 0);
  }
  EXPECT_NEAR(std::log2(area_error[0] / area_error[1]), 2, 0.1);
  EXPECT_NEAR(std::log2(volume_error[0] / volume_error[1]), 2, 0.1);
  EXPECT_LT(volume_error[1], 1e-3);
}

TEST(IsoSurface, OffsetsOfATorusKeepItsTopology) {
  const double major = 0.033, minor = 0.016;
  const FieldGrid grid = cubeGrid(0.05, 100);
  const SurfaceField field = sampleFunction(torusDistance(major, minor), grid, 8);
  for (const double voxels : {-6.0, -2.5, 0.0, 1.0, 5.99}) {
    const double iso = voxels * grid.voxel;
    const TriangleMesh mesh = isoSurface(field, iso);
    const Topology topology = topologyOf(mesh);
    EXPECT_TRUE(topology.closed_manifold) << voxels;
    EXPECT_EQ(topology.euler, 0) << voxels;
    EXPECT_NEAR(volume(mesh) / (2 * M_PI * M_PI * major * (minor + iso) * (minor + iso)), 1, 0.01);
  }
}

// Small and crossing shapes contain the ambiguous patterns; the surface must be closed in all.
TEST(IsoSurface, IsClosedAndManifoldForNoise) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> noise(-1, 1);
  const FieldGrid grid{Vec3::Zero(), 1, {33, 33, 33}};
  SurfaceField field = sampleFunction([](const Vec3&) { return 0.0; }, grid, 8);
  for (std::size_t slot = 0; slot < field.blockCount(); ++slot) {
    DistanceNodes nodes;
    for (float& phi : nodes.phi) phi = noise(random);
    // Outside nodes surround the field, so that the surface does not leave it.
    for (int n = 0; n < kBlockNodes; ++n) {
      const auto& at = field.block_at[slot];
      const int i = 8 * at[0] + n % 8, j = 8 * at[1] + n / 8 % 8, k = 8 * at[2] + n / 64;
      if (std::min({i, j, k}) < 1 || std::max({i, j, k}) > 31)
        nodes.phi[static_cast<std::size_t>(n)] = 1;
    }
    field.distance[slot] = std::make_shared<const DistanceBlock>(nodes);
  }
  const TriangleMesh mesh = isoSurface(field, 0);
  EXPECT_GT(mesh.triangles.size(), 50000U);
  EXPECT_TRUE(topologyOf(mesh).closed_manifold);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    ASSERT_GT(faceNormal(mesh, t).norm(), 0.5) << "a triangle without area";
}

TEST(IsoSurface, LeavesOutCellsAtTheBandsEndAndTheirVertices) {
  const FieldGrid grid = cubeGrid(0.05, 64);
  const SurfaceField field = sampleFunction(sphereDistance(0.05), grid, 8);
  const TriangleMesh mesh = isoSurface(field, -7.5 * grid.voxel);
  std::vector<bool> used(mesh.positions.size());
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t) used.at(static_cast<std::size_t>(v)) = true;
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
  for (const Vec3& p : mesh.positions)
    EXPECT_NEAR(p.norm(), 0.05 - 7.5 * grid.voxel, 0.1 * grid.voxel);
}

TEST(IsoSurface, RefusesAnIsoValueOutsideTheBand) {
  const FieldGrid grid = cubeGrid(0.05, 40);
  const SurfaceField field = sampleFunction(sphereDistance(0.05), grid, 8);
  EXPECT_THROW(isoSurface(field, 8 * grid.voxel), std::invalid_argument);
  EXPECT_THROW(isoSurface(field, std::nan("")), std::invalid_argument);
}

TEST(Dinosaur, IsOneClosedBodyAHundredMillimetresLong) {
  const TriangleMesh mesh = dinosaur();
  const Topology topology = topologyOf(mesh);
  EXPECT_TRUE(topology.closed_manifold);
  EXPECT_EQ(topology.components, 1U);
  EXPECT_EQ(topology.euler, 2);
  const Box3 box = bounds(mesh);
  EXPECT_NEAR(box.sizes().x(), 0.1, 1e-12);
  EXPECT_LT(box.center().norm(), 1e-12);
  EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), 70000, 7000);
  EXPECT_GT(volume(mesh), 1e-5);
}

// A node at the iso value counts as outside: a tip there does not touch.
TEST(IsoSurface, IsEmptyIfTheFieldIsNowhereBelowTheValue) {
  const FieldGrid grid{Vec3::Zero(), 1, {17, 17, 17}};
  const SurfaceField field =
      sampleFunction([](const Vec3& p) { return (p - Vec3(8, 8, 8)).norm(); }, grid, 8);
  EXPECT_TRUE(isoSurface(field, 0).triangles.empty());
  EXPECT_FALSE(isoSurface(field, 0.1).triangles.empty());
}

} // namespace
} // namespace patina
