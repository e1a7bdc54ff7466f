// A built field against brute force over all triangles (T-K01e, T-K02); bad input, cancelling and
// threads.
#include "field/construction/build_field.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/error.h"
#include "geometry/mesh/shapes.h"
#include "geometry/tree/triangle_tree.h"
#include "support/changed_mesh.h"
#include "support/node_values.h"

namespace patina {
namespace {

using test::inverted;
using test::moved;

BuiltField build(const TriangleMesh& mesh, int resolution, double band = 3) {
  FieldSpec spec;
  spec.resolution = resolution;
  spec.band = band;
  spec.sides = OpenSides::automatic_two; // its distances are those of the mesh alone
  Progress progress;
  return buildField(mesh, spec, progress);
}

double faceDistance(const TriangleMesh& mesh, std::size_t face, const Vec3& p) {
  const Vec3 a = mesh.corner(face, 0), b = mesh.corner(face, 1), c = mesh.corner(face, 2);
  const Vec3 w = closestBarycentric(p, a, b, c); // itself checked in triangle_tree_test
  return (p - (w[0] * a + w[1] * b + w[2] * c)).norm();
}

double bruteForce(const TriangleMesh& mesh, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    best = std::min(best, faceDistance(mesh, i, p));
  return best;
}

TriangleMesh oneTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{a, b, c}, {{0, 1, 2}}, {}};
}

// Every node of the grid (every `stride`-th): exact distance and nearest face in the band, nothing
// beyond it. Tolerances of T-K01e and T-K02: 1e-6 of the extent; and 1e-4 voxel.
void expectExact(const TriangleMesh& mesh, const BuiltField& built, int stride = 1) {
  const SurfaceField& field = *built.field;
  const FieldGrid& grid = field.grid;
  const double h = grid.voxel;
  const double extent = h * std::max({grid.nodes[0], grid.nodes[1], grid.nodes[2]});
  const double tolerance = std::min(1e-6 * extent, 1e-4 * h);
  std::size_t in_band = 0;
  for (int k = 0; k < grid.nodes[2]; k += stride)
    for (int j = 0; j < grid.nodes[1]; j += stride)
      for (int i = 0; i < grid.nodes[0]; i += stride) {
        const Vec3 p = grid.toWorld(Vec3(i, j, k));
        const double truth = bruteForce(mesh, p);
        const double phi = std::abs(static_cast<double>(test::phiAt(field, i, j, k))) * h;
        const std::int32_t face = field.faceAt(i, j, k);
        if (truth > (field.band + 1e-4) * h) {
          ASSERT_EQ(std::abs(test::phiAt(field, i, j, k)), kBackground)
              << i << ' ' << j << ' ' << k;
          ASSERT_EQ(face, -1);
        } else if (truth <= field.band * h) {
          ++in_band;
          ASSERT_NEAR(phi, truth, tolerance) << i << ' ' << j << ' ' << k;
          ASSERT_GE(face, 0);
          ASSERT_NEAR(faceDistance(mesh, static_cast<std::size_t>(face), p), truth, tolerance);
        }
      }
  EXPECT_GT(in_band, 0u);
}

TEST(BuildField, IsExactOnEveryNode) {
  for (const TriangleMesh& mesh :
       {icosphere(1, 3), torus(1, 0.3, 14, 8), box(Vec3(1, 0.7, 0.4)), box(Vec3(1, 1, 1), 3),
        moved(icosphere(0.05, 2), Vec3(0.1, -0.2, 0.3))})
    for (const int n : {9, 10, 20}) {
      const BuiltField built = build(mesh, n);
      expectExact(mesh, built);
    }
}

TEST(BuildField, IsExactAtEightVoxelsOfBand) {
  const TriangleMesh mesh = torus(1, 0.35, 12, 8);
  expectExact(mesh, build(mesh, 34, 8), 2);
}

TEST(BuildField, IsExactOnThinAndLongShapes) {
  expectExact(box(Vec3(1, 1, 1e-3)), build(box(Vec3(1, 1, 1e-3)), 24)); // thinner than a voxel
  expectExact(box(Vec3(1, 1e-3, 1e-3)), build(box(Vec3(1, 1e-3, 1e-3)), 60));
  const TriangleMesh triangle = oneTriangle({0, 0, 0}, {1, 0.1, 0}, {0.2, 0.8, 0.3});
  expectExact(triangle, build(triangle, 20));
  const TriangleMesh needle = oneTriangle({0, 0, 0}, {1, 0.3, 0.2}, {1, 0.3 + 1e-6, 0.2});
  expectExact(needle, build(needle, 24));
  const TriangleMesh flat = sheet(1, 1, 4); // every node's z on one plane
  expectExact(flat, build(flat, 20));
}

TEST(BuildField, IsExactOnDoubledAndOverlappingMeshes) {
  const TriangleMesh sphere = icosphere(1, 3);
  const TriangleMesh doubled = joined(sphere, inverted(sphere));
  const BuiltField built = build(doubled, 20);
  expectExact(doubled, built);
  for (const auto& block : built.field->face)
    for (std::size_t n = 0; n < kBlockNodes; ++n) // ties go to the first copy
      EXPECT_LT(block->at(n), static_cast<std::int32_t>(sphere.triangles.size()));
  const TriangleMesh overlap = joined(sphere, moved(box(Vec3(1, 1, 1)), Vec3(0.8, 0, 0)));
  expectExact(overlap, build(overlap, 24));
}

// Short form of the 400^3 grid with random nodes only.
TEST(BuildField, IsExactInALargeGrid) {
  const TriangleMesh mesh = box(Vec3(1, 0.02, 0.8)); // triangles of 400 voxels
  const BuiltField built = build(mesh, 400);
  const FieldGrid& grid = built.field->grid;
  std::mt19937 random(4);
  int in_band = 0;
  for (int n = 0; n < 40000; ++n) {
    const auto pick = [&](int a) {
      return std::uniform_int_distribution<int>(0, grid.nodes[static_cast<std::size_t>(a)] -
                                                       1)(random);
    };
    const int i = pick(0), j = pick(1), k = pick(2);
    const double truth = bruteForce(mesh, grid.toWorld(Vec3(i, j, k))) / grid.voxel;
    if (truth > built.field->band) continue;
    ++in_band;
    ASSERT_NEAR(std::abs(test::phiAt(*built.field, i, j, k)), truth, 1e-4);
    ASSERT_GE(built.field->faceAt(i, j, k), 0);
  }
  EXPECT_GT(in_band, 5000);
}

TEST(BuildField, IsTheSameFarFromTheOrigin) {
  const TriangleMesh mesh = torus(0.05, 0.02, 20, 10);
  // Adding a power of two keeps the vertices' low bits.
  const TriangleMesh away = moved(mesh, Vec3::Constant(std::exp2(17)));
  const BuiltField far = build(away, 24);
  expectExact(away, far);
  const BuiltField near = build(mesh, 24);
  EXPECT_EQ(far.field->blockCount(), near.field->blockCount());
}

TEST(BuildField, StoresOnlyBlocksWithANodeInTheBand) {
  const BuiltField built = build(icosphere(1, 6), 80);
  const SurfaceField& field = *built.field;
  ASSERT_EQ(field.distance.size(), field.blockCount());
  ASSERT_EQ(field.face.size(), field.blockCount());
  for (std::size_t slot = 0; slot < field.blockCount(); ++slot) {
    int in_band = 0;
    const auto distance = field.distance[slot]->phi();
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      const float phi = std::abs(distance[n]);
      in_band += phi <= field.band;
      EXPECT_EQ(field.face[slot]->at(n) >= 0, phi <= field.band);
    }
    EXPECT_GT(in_band, 0);
    const auto& at = field.block_at[slot];
    EXPECT_EQ(field.slotOf(at[0], at[1], at[2]), static_cast<std::int32_t>(slot));
  }
  EXPECT_LT(field.blockCount(), field.block_index.size() / 2);
}

// Lipschitz (T-K01e): neighbours differ by no more than their distance.
TEST(BuildField, NeverChangesFasterThanDistance) {
  const BuiltField built = build(joined(icosphere(1, 4), box(Vec3(1.5, 1.5, 1.5))), 40);
  const SurfaceField& field = *built.field;
  for (int k = 0; k < field.grid.nodes[2]; ++k)
    for (int j = 0; j < field.grid.nodes[1]; ++j)
      for (int i = 0; i + 1 < field.grid.nodes[0]; ++i) {
        const float a = test::phiAt(field, i, j, k), b = test::phiAt(field, i + 1, j, k);
        if (std::abs(a) >= kBackground || std::abs(b) >= kBackground) continue;
        EXPECT_LE(std::abs(a - b), 1 + 1e-5f);
      }
}

TEST(BuildField, CoarseNodesAreExactAndPointAwayFromTheSurface) {
  const TriangleMesh mesh = icosphere(1, 6);
  const BuiltField built = build(mesh, 60);
  const SurfaceField& field = *built.field;
  const std::array<int, 3> n{field.blocks[0] + 1, field.blocks[1] + 1, field.blocks[2] + 1};
  ASSERT_EQ(field.coarse.size(), static_cast<std::size_t>(n[0] * n[1] * n[2]));
  const TriangleTree tree(mesh);
  int inside = 0;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const Vec3 p = field.grid.toWorld(kBlockSide * Vec3(i, j, k));
        const CoarseNode& node = field.coarse[static_cast<std::size_t>((k * n[1] + j) * n[0] + i)];
        const ClosestPoint closest = tree.closestPoint(p);
        const double sign = p.norm() < 0.99 ? -1 : 1;
        if (std::abs(p.norm() - 1) < 0.01) continue;
        inside += sign < 0;
        EXPECT_NEAR(node.phi, sign * closest.distance / field.grid.voxel, 1e-4);
        const Vec3 g(node.gx, node.gy, node.gz);
        EXPECT_NEAR(g.norm(), 1, 1e-5);
        EXPECT_GT(g.dot(p), 0); // the distance grows outwards, inside as well as outside
      }
  EXPECT_GT(inside, 0);
}

TEST(BuildField, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = torus(1, 0.35, 60, 30);
  const BuiltField many = build(mesh, 60);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const BuiltField single = build(mesh, 60);
  ASSERT_EQ(many.field->block_index, single.field->block_index);
  for (std::size_t slot = 0; slot < many.field->blockCount(); ++slot) {
    EXPECT_EQ(many.field->distance[slot]->phi(), single.field->distance[slot]->phi());
    for (std::size_t n = 0; n < kBlockNodes; ++n)
      ASSERT_EQ(many.field->face[slot]->at(n), single.field->face[slot]->at(n));
  }
}

TEST(BuildField, DropsAndCountsInvalidTriangles) {
  const TriangleMesh sphere = icosphere(1, 4);
  TriangleMesh broken;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  broken = joined(oneTriangle({nan, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                  oneTriangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}));
  broken = joined(broken, sphere);
  const BuiltField built = build(broken, 24);
  const BuiltField clean = build(sphere, 24);
  EXPECT_EQ(built.report.dropped_triangles, 2u);
  EXPECT_EQ(clean.report.dropped_triangles, 0u);
  ASSERT_EQ(built.field->blockCount(), clean.field->blockCount());
  for (std::size_t slot = 0; slot < built.field->blockCount(); ++slot) {
    EXPECT_EQ(built.field->distance[slot]->phi(), clean.field->distance[slot]->phi());
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      const std::int32_t face = clean.field->face[slot]->at(n);
      EXPECT_EQ(built.field->face[slot]->at(n), face < 0 ? -1 : face + 2);
    }
  }
}

TEST(BuildField, RefusesAMeshWithoutTriangles) {
  EXPECT_THROW(build({}, 24), Error);
  EXPECT_THROW(build(oneTriangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0}), 24), Error);
  EXPECT_THROW(build(icosphere(1, 2), 4), Error); // no room between the bands
}

TEST(BuildField, StopsWhenCancelled) {
  const TriangleMesh mesh = icosphere(1, 20);
  FieldSpec spec;
  spec.resolution = 100;
  Progress before;
  before.cancel();
  EXPECT_THROW(buildField(mesh, spec, before), Cancelled);
  for (const double at : {0.05, 0.3, 0.6}) {
    Progress* self = nullptr;
    double last = 0;
    Progress progress([&](double fraction, std::string_view) {
      last = fraction;
      if (fraction >= at) self->cancel();
    });
    self = &progress;
    EXPECT_THROW(buildField(mesh, spec, progress), Cancelled);
    EXPECT_LT(last, 1);
  }
}

TEST(BuildField, ReportsEachStepInOrder) {
  const auto steps = [](const TriangleMesh& mesh, bool cancelled) {
    std::vector<std::string> told;
    double first = -1, last = -1;
    Progress progress([&](double fraction, std::string_view what) {
      if (told.empty()) first = fraction;
      if (told.empty() || told.back() != what) told.emplace_back(what);
      last = fraction;
    });
    FieldSpec spec;
    spec.resolution = 60;
    if (cancelled) {
      progress.cancel();
      EXPECT_THROW(buildField(mesh, spec, progress), Cancelled);
    } else {
      buildField(mesh, spec, progress);
      EXPECT_EQ(first, 0);
      EXPECT_EQ(last, 1);
    }
    return told;
  };
  using Steps = std::vector<std::string>;
  EXPECT_EQ(steps(icosphere(1, 8), false), (Steps{"triangles", "distances", "signs", "field"}));
  EXPECT_EQ(steps(sheet(1, 1, 4), false),
            (Steps{"triangles", "distances", "signs", "distances", "field"}));
  EXPECT_EQ(steps(icosphere(1, 8), true), Steps{});
}

TEST(BuildField, ReportsItsFigures) {
  const BuiltField built = build(icosphere(1, 10), 60, 8);
  EXPECT_EQ(built.report.blocks, built.field->blockCount());
  EXPECT_EQ(built.report.bytes, built.field->bytes());
  EXPECT_EQ(built.report.dense_bytes, built.field->grid.nodeCount() * 8);
  EXPECT_GT(built.report.cpu_seconds, 0);
  EXPECT_GT(built.report.seconds, 0);
  EXPECT_EQ(built.report.ambiguous_signs, 0u);
}

} // namespace
} // namespace patina
