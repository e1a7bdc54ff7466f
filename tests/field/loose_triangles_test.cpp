// Meshes whose triangles share no corners: one body with an inside, or one sheet without.
#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "field/construction/build_field.h"
#include "field/store/node_reader.h"
#include "geometry/mesh/shapes.h"
#include "geometry/tree/triangle_tree.h"
#include "support/changed_mesh.h"
#include "support/loose_triangles.h"
#include "support/winding_sum.h"

namespace patina {
namespace {

using test::inverted;
using test::loose;
using test::moved;

constexpr int kSamples = 400;

BuiltField builtAs(const TriangleMesh& mesh, OpenSides sides = OpenSides::automatic) {
  FieldSpec spec;
  spec.resolution = 80;
  spec.sides = sides;
  Progress progress;
  return buildField(mesh, spec, progress);
}

double voxelOf(const TriangleMesh& mesh) {
  FieldSpec spec;
  spec.resolution = 80;
  return gridAround(bounds(mesh), spec).voxel;
}

// The share of wrong signs among random nodes at least `margin` voxels from the true surface.
double wrongShare(const TriangleMesh& truth, const BuiltField& field, double margin) {
  const FieldGrid& grid = field.field->grid;
  const TriangleTree tree(truth);
  NodeReader nodes(*field.field);
  std::mt19937 random(5);
  int judged = 0, wrong = 0;
  while (judged < kSamples) {
    std::array<int, 3> at{};
    for (std::size_t k = 0; k < 3; ++k)
      at[k] = static_cast<int>(random() % static_cast<unsigned>(grid.nodes[k]));
    const Vec3 p = grid.toWorld(Vec3(at[0], at[1], at[2]));
    if (tree.closestPoint(p).distance < margin * grid.voxel) continue;
    ++judged;
    const bool inside = std::abs(windingNumberBruteForce(truth, p)) > 0.5;
    wrong += (nodes.phiAt(at[0], at[1], at[2]) < 0) != inside;
  }
  return static_cast<double>(wrong) / kSamples;
}

TEST(LooseTriangles, FormOneBody) {
  const TriangleMesh ball = icosphere(0.05, 24);
  for (const TriangleMesh& mesh :
       {torus(0.04, 0.015, 80, 40), ball, box(Vec3(0.1, 0.06, 0.08), 24), vase(0.12, 0.01, 48, 25),
        joined(ball, inverted(icosphere(0.03, 16)))}) {
    const double voxel = voxelOf(mesh);
    for (const double shift : {0.01, 0.03, 0.1, 0.3})
      for (const bool corners : {false, true}) {
        const BuiltField made = builtAs(loose(mesh, shift * voxel, corners));
        EXPECT_EQ(made.report.open_triangles, 0U) << shift;
        EXPECT_LE(wrongShare(mesh, made, shift + 0.3), 0.001) << shift << ' ' << corners;
      }
  }
}

TEST(LooseTriangles, FormOneBodyDespiteOverlapsAndGaps) {
  const TriangleMesh ball = icosphere(0.05, 24);
  // Triangles shrunk by a fifth leave gaps that are too wide to be joined.
  for (const double shrunk : {-0.2, -0.05, 0.05}) {
    const BuiltField made = builtAs(withShrunkenTriangles(ball, shrunk));
    EXPECT_EQ(made.report.open_triangles, 0U) << shrunk;
    EXPECT_LE(wrongShare(ball, made, 0.6), 0.001) << shrunk;
  }
}

TEST(LooseTriangles, DoNotLeakIntoAThinBody) {
  const Vec3 size(0.1, 0.1, 0.005); // three voxels thick
  const double voxel = voxelOf(box(size));
  const BuiltField made = builtAs(loose(box(size, 40), 0.3 * voxel));
  const FieldGrid& grid = made.field->grid;
  NodeReader nodes(*made.field);
  std::size_t wrong = 0;
  for (int z = 0; z < grid.nodes[2]; ++z)
    for (int y = 0; y < grid.nodes[1]; ++y)
      for (int x = 0; x < grid.nodes[0]; ++x) {
        const Vec3 p = grid.toWorld(Vec3(x, y, z));
        const double beyond = (p.cwiseAbs() - 0.5 * size).maxCoeff(); // at most the distance
        wrong += std::abs(beyond) > 0.6 * voxel && (nodes.phiAt(x, y, z) < 0) != (beyond < 0);
      }
  EXPECT_LE(wrong, 3U); // 1, of 300,000 nodes
}

TEST(LooseTriangles, FormABodyBesideAWeldedOne) {
  const TriangleMesh ball = icosphere(0.05, 24),
                     solid = moved(box(Vec3(0.1, 0.06, 0.08), 4), Vec3(0.12, 0, 0));
  const TriangleMesh truth = joined(ball, solid);
  const BuiltField made = builtAs(joined(loose(ball, 0.2 * voxelOf(truth)), solid));
  EXPECT_EQ(made.report.open_triangles, 0U);
  EXPECT_LE(wrongShare(truth, made, 0.5), 0.001);
}

TEST(LooseTriangles, FormAnOpenSheet) {
  const TriangleMesh flat = sheet(0.1, 0.1, 40);
  const double voxel = voxelOf(flat);
  for (const double shift : {0.01, 0.1, 0.3}) {
    const TriangleMesh mesh = loose(flat, shift * voxel);
    EXPECT_EQ(builtAs(mesh).report.open_triangles, mesh.triangles.size()) << shift;
    const TriangleMesh two = joined(mesh, moved(mesh, Vec3(0, 0, 5 * voxel)));
    EXPECT_EQ(builtAs(two).report.open_triangles, two.triangles.size()) << shift;
  }
}

TriangleMesh withoutTop(TriangleMesh mesh, double height) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    double z = 0;
    for (const std::int32_t v : t) z += mesh.positions[static_cast<std::size_t>(v)].z() / 3;
    return z > height;
  });
  return mesh;
}

std::size_t negativeNodes(const SurfaceField& field) {
  std::size_t count = 0;
  for (const auto& block : field.distance)
    for (const float phi : block->phi()) count += phi < 0;
  return count;
}

TEST(SurfaceSides, AreThoseRequested) {
  const TriangleMesh scan = withoutTop(icosphere(0.05, 24), 0.02);
  EXPECT_EQ(builtAs(scan).report.open_parts, 0U);
  for (const OpenSides sides : {OpenSides::one, OpenSides::two, OpenSides::closed}) {
    for (const TriangleMesh& mesh : {scan, sheet(0.1, 0.1, 20)}) {
      const BuiltField made = builtAs(mesh, sides);
      ASSERT_EQ(made.report.parts.size(), 1U);
      EXPECT_EQ(made.report.parts[0].sides, sides);
      EXPECT_TRUE(made.report.parts[0].asked);
      if (sides == OpenSides::two) {
        EXPECT_EQ(negativeNodes(*made.field), 0U);
      }
    }
  }
  // Requested sides have no effect on parts without a boundary.
  const BuiltField ball = builtAs(icosphere(0.05, 24), OpenSides::two);
  EXPECT_EQ(ball.report.open_parts, 0U);
  EXPECT_TRUE(ball.report.parts.empty());
}

// A figure of eight makes two half turns about its centre on one way around.
TriangleMesh kleinBottle(int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double r = 3 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
      const double z = std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v);
      mesh.positions.push_back(0.01 * Vec3(r * std::cos(u), r * std::sin(u), z));
    }
  const auto at = [&](int i, int j) {
    return i == around ? (across - j) % across : i * across + j % across;
  };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TEST(SurfaceSides, MayBeTwoForAKleinBottle) {
  const TriangleMesh mesh = kleinBottle(60, 40);
  const BuiltField two = builtAs(mesh, OpenSides::two);
  EXPECT_EQ(two.report.open_triangles, mesh.triangles.size());
  EXPECT_EQ(negativeNodes(*two.field), 0U);
  EXPECT_EQ(builtAs(mesh).report.open_triangles, 0U);
}

// Six tetrahedra a cube, each with its four faces (Kuhn, 1960).
TriangleMesh tetrahedra(int cells, double size) {
  TriangleMesh mesh;
  const int n = cells + 1;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        mesh.positions.push_back(size * (Vec3(i, j, k) / cells - Vec3::Constant(0.5)));
  const int step[] = {1, n, n * n};
  constexpr std::tuple<int, int, bool> kOrders[] = {{0, 1, true},  {1, 2, true},  {2, 0, true},
                                                    {1, 0, false}, {2, 1, false}, {0, 2, false}};
  for (int k = 0; k < cells; ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i)
        for (const auto& [x, y, even] : kOrders) {
          const int a = (k * n + j) * n + i, d = a + step[0] + step[1] + step[2];
          int b = a + step[x], c = b + step[y];
          if (!even) std::swap(b, c);
          for (const Triangle& t :
               {Triangle{a, c, b}, Triangle{a, b, d}, Triangle{b, c, d}, Triangle{a, d, c}})
            mesh.triangles.push_back(t);
        }
  return mesh;
}

TEST(InnerFaces, AreOmittedForATetrahedralMesh) {
  const TriangleMesh mesh = tetrahedra(16, 0.1); // 98,304 faces
  const BuiltField made = builtAs(mesh), solid = builtAs(box(Vec3::Constant(0.1), 16));
  std::printf("%zu faces: %.2f s of CPU\n", mesh.triangles.size(), made.report.cpu_seconds);
  EXPECT_EQ(made.report.inner_triangles, mesh.triangles.size() - 12 * 16 * 16);
  EXPECT_EQ(made.report.ambiguous_signs, 0U);
  EXPECT_EQ(made.report.open_triangles, 0U);
  EXPECT_LE(wrongShare(box(Vec3::Constant(0.1)), made, 0.01), 0);
  ASSERT_EQ(made.field->blockCount(), solid.field->blockCount());
  for (std::size_t slot = 0; slot < made.field->blockCount(); ++slot) {
    const auto a = made.field->distance[slot]->phi(), b = solid.field->distance[slot]->phi();
    for (std::size_t n = 0; n < a.size(); ++n) ASSERT_NEAR(a[n], b[n], 1e-4);
  }
}

} // namespace
} // namespace patina
