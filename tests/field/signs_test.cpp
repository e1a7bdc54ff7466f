#include "field/signs/signs.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "field/construction/build_field.h"
#include "field/construction/distance_blocks.h"
#include "field/sampling/field_sampler.h"
#include "geometry/mesh/shapes.h"
#include "support/changed_mesh.h"
#include "support/mesh_defects.h"
#include "support/node_values.h"
#include "support/soup.h"

namespace patina {
namespace {

using test::inverted;
using test::moved;

using Truth = std::function<double(const Vec3&)>; // signed distance [m]

TriangleMesh withMovedCorners(const TriangleMesh& mesh, double by, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, by);
  TriangleMesh result = soup(mesh);
  for (Vec3& p : result.positions) p += Vec3(normal(random), normal(random), normal(random));
  return result;
}

constexpr double kBallRadius = 0.05;
double ballTruth(const Vec3& p) {
  return p.norm() - kBallRadius;
}
TriangleMesh ballMesh() {
  return icosphere(kBallRadius, 30);
}
double torusTruth(const Vec3& p) {
  return std::hypot(std::hypot(p.x(), p.y()) - 0.04, p.z()) - 0.015;
}
Truth boxTruth(const Vec3& size) {
  return [size](const Vec3& p) {
    const Vec3 q = p.cwiseAbs() - size / 2;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
  };
}

struct Wrong {
  double points = 0; // fraction of random points farther than h sqrt(3)/2 from the surface
  double nodes = 0;  // fraction of all nodes outside the facet error
  std::size_t ambiguous = 0;
};

constexpr double kFacetSag = 0.05; // voxels; more than the facet error of any mesh below

Wrong wrongSigns(const TriangleMesh& mesh, const Truth& truth, int resolution = 80,
                 unsigned seed = 1) {
  FieldSpec spec;
  spec.resolution = resolution;
  Progress progress;
  const BuiltField built = buildField(mesh, spec, progress);
  const auto field = withSamples(built.field);
  const FieldGrid& grid = field->grid;
  Wrong wrong;
  wrong.ambiguous = built.report.ambiguous_signs;

  std::size_t count = 0, bad = 0;
  for (int k = 0; k < grid.nodes[2]; ++k)
    for (int j = 0; j < grid.nodes[1]; ++j)
      for (int i = 0; i < grid.nodes[0]; ++i) {
        const double d = truth(grid.toWorld(Vec3(i, j, k))) / grid.voxel;
        if (std::abs(d) < kFacetSag) continue;
        ++count;
        bad += (test::phiAt(*field, i, j, k) < 0) != (d < 0);
      }
  wrong.nodes = static_cast<double>(bad) / static_cast<double>(count);

  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const FieldSampler sampler(*field, Sampler::kim);
  count = bad = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 q((grid.nodes[0] - 1) * unit(random), (grid.nodes[1] - 1) * unit(random),
                 (grid.nodes[2] - 1) * unit(random));
    const double d = truth(grid.toWorld(q)) / grid.voxel;
    if (std::abs(d) < std::sqrt(3.0) / 2) continue;
    ++count;
    bad += (sampler.phiAtGrid(q) < 0) != (d < 0);
  }
  wrong.points = static_cast<double>(bad) / static_cast<double>(count);
  return wrong;
}

void expectNone(const TriangleMesh& mesh, const Truth& truth) {
  const Wrong wrong = wrongSigns(mesh, truth);
  EXPECT_EQ(wrong.points, 0);
  EXPECT_EQ(wrong.nodes, 0);
}

// T-K01d
TEST(Signs, NoneWrongNorAmbiguousOnClosedMeshes) {
  const std::vector<std::pair<TriangleMesh, Truth>> shapes{
      {ballMesh(), ballTruth},
      {torus(0.04, 0.015, 120, 60), torusTruth},
      {box(Vec3(0.1, 0.07, 0.03), 1), boxTruth(Vec3(0.1, 0.07, 0.03))},
      {box(Vec3(0.1, 0.07, 0.03), 20), boxTruth(Vec3(0.1, 0.07, 0.03))}};
  for (const auto& [mesh, truth] : shapes) {
    expectNone(mesh, truth);
    EXPECT_EQ(wrongSigns(mesh, truth).ambiguous, 0U);
  }
}

TEST(Signs, NoneWrongForAnyInputFormOfAClosedMesh) {
  expectNone(inverted(ballMesh()), ballTruth);
  expectNone(soup(ballMesh()), ballTruth);
  expectNone(soup(inverted(torus(0.04, 0.015, 120, 60))), torusTruth);
  expectNone(joined(ballMesh(), ballMesh()), ballTruth);
  expectNone(joined(ballMesh(), inverted(ballMesh())), ballTruth);
}

TEST(Signs, NoneWrongInTheUnionOfOverlappingBodies) {
  const Vec3 by(0.03, 0.01, 0.005);
  expectNone(joined(ballMesh(), moved(ballMesh(), by)), [by](const Vec3& p) {
    // Inside both bodies the distance to the union's surface does not matter, only the sign does.
    return std::min(ballTruth(p), ballTruth(p - by));
  });
}

TEST(Signs, CavityIsOutside) {
  const double inner = 0.03;
  const auto truth = [inner](const Vec3& p) { return std::max(ballTruth(p), inner - p.norm()); };
  const TriangleMesh hollow = joined(ballMesh(), inverted(icosphere(inner, 20)));
  expectNone(hollow, truth);
  expectNone(inverted(hollow), truth);
  expectNone(withFlippedFaces(hollow, 0.2, 3), truth);
}

TEST(Signs, FewWrongWithHoles) {
  for (unsigned seed : {1U, 2U, 3U}) {
    const Wrong wrong =
        wrongSigns(withHoles(ballMesh(), 12, 0.1 * kBallRadius, seed), ballTruth, 150, seed);
    EXPECT_LE(wrong.points, 0.001);
    EXPECT_LE(wrong.nodes, 0.003);
    EXPECT_GT(wrong.ambiguous, 0U);
  }
}

TEST(Signs, FewWrongWithHolesInADoubledMesh) {
  const TriangleMesh mesh = withHoles(ballMesh(), 12, 0.1 * kBallRadius, 1);
  for (const TriangleMesh& doubled : {joined(mesh, mesh), joined(mesh, inverted(mesh))}) {
    const Wrong wrong = wrongSigns(doubled, ballTruth, 150);
    EXPECT_LE(wrong.points, 0.001);
    EXPECT_LE(wrong.nodes, 0.003);
    EXPECT_GT(wrong.ambiguous, 0U);
  }
}

// Connected closed faces are flipped until they agree, and no node is ambiguous.
TEST(Signs, NoneWrongWithFlippedFaces) {
  const Vec3 size(0.1, 0.07, 0.03);
  for (double fraction : {0.05, 0.4, 0.5}) {
    for (const auto& [mesh, truth] :
         std::vector<std::pair<TriangleMesh, Truth>>{{ballMesh(), ballTruth},
                                                     {torus(0.04, 0.015, 120, 60), torusTruth},
                                                     {box(size, 20), boxTruth(size)},
                                                     {soup(box(size, 20)), boxTruth(size)}}) {
      const Wrong wrong = wrongSigns(withFlippedFaces(mesh, fraction, 1), truth);
      EXPECT_EQ(wrong.points, 0) << fraction;
      EXPECT_EQ(wrong.nodes, 0) << fraction;
      EXPECT_EQ(wrong.ambiguous, 0U) << fraction;
    }
  }
}

// Shrunken faces share no edge that shows which are flipped: the inside cannot be told, and the
// nodes count as ambiguous.
TEST(Signs, LooseFacesThatFaceAnywhereAreCounted) {
  const TriangleMesh loose = withShrunkenTriangles(ballMesh(), 0.002);
  EXPECT_EQ(wrongSigns(loose, ballTruth).points, 0);
  EXPECT_GT(wrongSigns(withFlippedFaces(loose, 0.5, 1), ballTruth).ambiguous, 500U);
}

TEST(Signs, NoneWrongInTheUnionOfBodiesThatFaceOppositeWays) {
  const Vec3 by(0.03, 0.01, 0.005);
  const Truth both = [by](const Vec3& p) { return std::min(ballTruth(p), ballTruth(p - by)); };
  expectNone(joined(ballMesh(), inverted(moved(ballMesh(), by))), both);
  expectNone(joined(inverted(ballMesh()), moved(ballMesh(), by)), both);
  expectNone(joined(inverted(ballMesh()), inverted(moved(ballMesh(), by))), both);
}

TEST(Signs, FewWrongWithHolesAndFlippedFaces) {
  const Wrong wrong = wrongSigns(
      withFlippedFaces(withHoles(ballMesh(), 12, 0.1 * kBallRadius, 4), 0.05, 5), ballTruth);
  EXPECT_LE(wrong.points, 0.003);
  EXPECT_LE(wrong.nodes, 0.003);
  EXPECT_GT(wrong.ambiguous, 0U);
}

TEST(Signs, FewWrongWithCracks) {
  for (double fraction : {1e-6, 0.002, 0.01, 0.1}) {
    for (const auto& [mesh, truth] : std::vector<std::pair<TriangleMesh, Truth>>{
             {ballMesh(), ballTruth}, {torus(0.04, 0.015, 120, 60), torusTruth}}) {
      const Wrong wrong = wrongSigns(withShrunkenTriangles(mesh, fraction), truth);
      EXPECT_EQ(wrong.points, 0) << fraction;
      EXPECT_LE(wrong.nodes, 0.001) << fraction;
      EXPECT_TRUE(wrong.nodes == 0 || wrong.ambiguous > 0) << fraction;
    }
  }
  for (unsigned seed : {1U, 2U}) { // corners off by 0.2 % of the radius: gaps and overlaps
    const Wrong wrong =
        wrongSigns(withMovedCorners(ballMesh(), 0.002 * kBallRadius, seed), ballTruth, 150, seed);
    EXPECT_EQ(wrong.points, 0);
    EXPECT_LE(wrong.nodes, 0.002);
    EXPECT_TRUE(wrong.nodes == 0 || wrong.ambiguous > 0);
  }
}

// Faces are 25 voxels wide: beside a flipped one every winding number is wrong, and is outvoted.
TEST(Signs, LargeFlippedFacesAreOutvoted) {
  FieldSpec spec;
  spec.resolution = 150;
  Progress progress;
  const TriangleMesh mesh = icosphere(kBallRadius, 4);
  const auto sound = buildField(mesh, spec, progress).field;
  const auto flipped = buildField(withFlippedFaces(mesh, 0.05, 6), spec, progress).field;
  ASSERT_EQ(sound->blockCount(), flipped->blockCount());
  EXPECT_EQ(sound->block_index, flipped->block_index);
  std::size_t different = 0;
  for (std::size_t slot = 0; slot < sound->blockCount(); ++slot) {
    const auto a = sound->distance[slot]->phi(), b = flipped->distance[slot]->phi();
    for (std::size_t n = 0; n < kBlockNodes; ++n) different += (a[n] < 0) != (b[n] < 0);
  }
  EXPECT_EQ(different, 0U);
}

// The wall is thinner than a voxel: components of its two sides must not join through it.
TEST(Signs, ThinWallsHaveTwoOutsides) {
  for (double thickness : {0.003, 0.0011, 0.0003}) {
    const Vec3 size(0.1, 0.08, thickness);
    FieldSpec spec;
    spec.voxel = 0.001;
    for (double shift : {0.0, 0.0002, 0.00049}) {
      // The wall lies at different positions between the layers of nodes around its centre.
      Progress progress;
      const Vec3 off(0, 0, shift);
      const TriangleMesh mesh =
          joined(moved(box(size, 3), off), moved(box(Vec3(1, 1, 1) * 1e-4, 1), Vec3(0, 0, 0.02)));
      const auto field = buildField(mesh, spec, progress).field;
      const Truth truth = boxTruth(size);
      std::size_t wrong = 0, inside = 0;
      const FieldGrid& grid = field->grid;
      for (int k = 0; k < grid.nodes[2]; ++k)
        for (int j = 0; j < grid.nodes[1]; ++j)
          for (int i = 0; i < grid.nodes[0]; ++i) {
            const Vec3 p = grid.toWorld(Vec3(i, j, k));
            const double d = truth(p - off);
            if (std::abs(d) < 1e-8 || p.z() > 0.015) continue;
            inside += d < 0;
            wrong += (test::phiAt(*field, i, j, k) < 0) != (d < 0);
          }
      EXPECT_EQ(wrong, 0U) << thickness << " " << shift;
      if (thickness > 0.001) {
        EXPECT_GT(inside, 0U);
      }
    }
  }
}

TEST(Signs, NodesOnTheSurfaceArePositiveZeros) {
  FieldSpec spec;
  spec.voxel = 0.0078125; // binary fractions: nodes lie exactly on the faces
  Progress progress;
  const BuiltField built = buildField(box(Vec3(0.125, 0.125, 0.125), 2), spec, progress);
  std::size_t zeros = 0;
  for (const auto& block : built.field->distance)
    for (float phi : block->phi()) {
      if (std::abs(phi) > 1e-6F) continue;
      ++zeros;
      EXPECT_FALSE(std::signbit(phi));
    }
  EXPECT_EQ(zeros, 17U * 17 * 6 - 12U * 17 + 8); // nodes on the surface of a cube, 17 a side
  EXPECT_EQ(built.report.ambiguous_signs, 0U);
}

TEST(Signs, UnstoredBlocksAndCoarseNodesAreSigned) {
  FieldSpec spec;
  spec.resolution = 150;
  spec.band = 3;
  Progress progress;
  const auto field = buildField(inverted(ballMesh()), spec, progress).field;
  std::size_t inside = 0;
  for (int z = 0; z < field->blocks[2]; ++z)
    for (int y = 0; y < field->blocks[1]; ++y)
      for (int x = 0; x < field->blocks[0]; ++x) {
        const std::int32_t slot = field->slotOf(x, y, z);
        if (slot >= 0) continue;
        const double d = ballTruth(field->grid.toWorld(8 * Vec3(x, y, z) + Vec3::Constant(3.5)));
        EXPECT_EQ(slot == SurfaceField::kInside, d < 0);
        inside += slot == SurfaceField::kInside;
      }
  EXPECT_GT(inside, 100U);
  std::size_t corner = 0;
  for (int z = 0; z <= field->blocks[2]; ++z)
    for (int y = 0; y <= field->blocks[1]; ++y)
      for (int x = 0; x <= field->blocks[0]; ++x, ++corner) {
        const Vec3 p = field->grid.toWorld(8 * Vec3(x, y, z));
        const CoarseNode& node = field->coarse[corner];
        EXPECT_NEAR(node.phi, ballTruth(p) / field->grid.voxel, 0.1);
        if (p.norm() > 0.01) {
          EXPECT_GT(Vec3(node.gx, node.gy, node.gz).dot(p.normalized()), 0.99);
        }
      }
}

TEST(Signs, AreDeterministic) {
  const TriangleMesh mesh = withFlippedFaces(withHoles(ballMesh(), 12, 0.006, 7), 0.05, 8);
  FieldSpec spec;
  spec.resolution = 80;
  Progress progress;
  const BuiltField first = buildField(mesh, spec, progress);
  const BuiltField second = buildField(mesh, spec, progress);
  EXPECT_EQ(first.report.ambiguous_signs, second.report.ambiguous_signs);
  EXPECT_EQ(first.field->block_index, second.field->block_index);
  for (std::size_t slot = 0; slot < first.field->blockCount(); ++slot)
    ASSERT_EQ(first.field->distance[slot]->phi(), second.field->distance[slot]->phi());
}

TEST(Signs, CanBeCancelled) {
  const TriangleMesh mesh = ballMesh();
  const TriangleTree tree(mesh);
  const WindingNumber winding(mesh);
  FieldSpec spec;
  spec.resolution = 60;
  Progress progress;
  FieldBuilder builder =
      distanceBlocks(mesh, tree, gridAround(bounds(mesh), spec), spec.band, progress, 0, 1);
  progress.cancel();
  EXPECT_THROW(assignSigns(builder, mesh, tree, winding, {}, 0, progress), Cancelled);
}

} // namespace
} // namespace patina
