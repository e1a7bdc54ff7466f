// K14: the union is as exact as its parts, names the owner of each node, and costs like one object.
#include "field/merge/merge_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "field/analytic_fields.h"
#include "field/merged_shapes.h"
#include "field/sampling/field_sampler.h"
#include "geometry/mesh/combined_mesh.h"
#include "geometry/tree/triangle_tree.h"
#include "support/node_values.h"

namespace patina {
namespace {

using test::mergedShapes;
using test::MergedShapes;
using test::movedBy;

template <class Visit> void forPlaces(const SurfaceField& field, const Visit& visit) {
  for (const auto& at : field.block_at)
    for (int n = 0; n < kBlockNodes; ++n)
      visit(kBlockSide * at[0] + n % kBlockSide, kBlockSide * at[1] + n / kBlockSide % kBlockSide,
            kBlockSide * at[2] + n / (kBlockSide * kBlockSide));
}

MergedShapes twoSpheres(double apart) {
  return mergedShapes({movedBy(icosphere(0.02, 16), Vec3(-apart / 2, 0, 0)),
                       movedBy(icosphere(0.02, 16), Vec3(apart / 2, 0, 0))});
}

// T-K14a, T-K14b.
TEST(MergeFields, IsExactOutsideAndNeverTooDeepInside) {
  const MergedShapes m = twoSpheres(0.02);
  const TriangleTree a(movedBy(icosphere(0.02, 16), Vec3(-0.01, 0, 0)));
  const TriangleTree b(movedBy(icosphere(0.02, 16), Vec3(0.01, 0, 0)));
  std::size_t outside = 0, inside = 0;
  forPlaces(*m.field, [&](int i, int j, int k) {
    const Vec3 p = m.field->grid.toWorld(Vec3(i, j, k));
    const auto phi = static_cast<double>(test::phiAt(*m.field, i, j, k));
    if (std::abs(phi) >= static_cast<double>(kBackground)) return;
    const double da = a.closestPoint(p).distance, db = b.closestPoint(p).distance;
    if (phi > 0) {
      EXPECT_NEAR(phi * m.lattice.voxel, std::min(da, db),
                  1e-4 * m.lattice.voxel); // a tie of faces
      ++outside;
    } else {
      // Closed form of the union's depth: to a foot that is not hidden, or to the circle of the
      // crease.
      const double r = std::hypot(p.y(), p.z());
      double depth = std::hypot(p.x(), r - std::sqrt(3e-4));
      for (const double x : {-0.01, 0.01}) {
        const Vec3 from = p - Vec3(x, 0, 0);
        const Vec3 foot = Vec3(x, 0, 0) + 0.02 / from.norm() * from;
        if ((foot + Vec3(x, 0, 0)).norm() >= 0.02)
          depth = std::min(depth, std::abs(0.02 - from.norm()));
      }
      EXPECT_LE(-phi * m.lattice.voxel, depth + 6e-5); // depth of the facets below the sphere
      ++inside;
    }
  });
  EXPECT_GT(outside, 100000u);
  EXPECT_GT(inside, 100000u);
}

TEST(MergeFields, NodesHoldTheMinimumOfThePartsAndItsOwner) {
  const MergedShapes m = twoSpheres(0.03);
  std::size_t of[2] = {0, 0};
  forPlaces(*m.field, [&](int i, int j, int k) {
    float least = std::numeric_limits<float>::infinity();
    std::int32_t face = -1, owner = -1;
    BlockBox all = m.parts[0].blocks();
    all.extend(m.parts[1].blocks());
    for (std::size_t p = 0; p < 2; ++p) {
      std::array<int, 3> in{i, j, k};
      for (std::size_t a = 0; a < 3; ++a)
        in[a] -= kBlockSide * (m.parts[p].first_block[a] - all.low[a]);
      const float phi = test::phiAt(*m.parts[p].field, in[0], in[1], in[2]);
      if (!(phi < least)) continue;
      least = phi;
      owner = static_cast<std::int32_t>(p);
      const std::int32_t own = m.parts[p].field->faceAt(in[0], in[1], in[2]);
      face = own < 0 ? -1 : own + m.parts[p].first_face;
    }
    ASSERT_EQ(test::phiAt(*m.field, i, j, k), least);
    ASSERT_EQ(m.field->faceAt(i, j, k), face);
    if (face < 0) return;
    ASSERT_EQ(objectOfFace(m.parts, face, &FieldPart::first_face), owner);
    ++of[owner];
  });
  EXPECT_GT(of[0], 10000u);
  EXPECT_GT(of[1], 10000u);
  EXPECT_EQ(objectOfFace(m.parts, -1, &FieldPart::first_face), -1);
}

TEST(MergeFields, IdenticalObjectsEqualOneBitForBit) {
  const TriangleMesh ball = icosphere(0.02, 16);
  const MergedShapes one = mergedShapes({ball}), two = mergedShapes({ball, ball});
  ASSERT_EQ(two.field->block_index, one.field->block_index);
  for (std::size_t s = 0; s < one.field->blockCount(); ++s)
    ASSERT_EQ(two.field->distance[s]->phi(), one.field->distance[s]->phi());
  forPlaces(*two.field, [&](int i, int j, int k) { // the first owns every tie
    ASSERT_EQ(two.field->faceAt(i, j, k), one.field->faceAt(i, j, k));
  });
  for (std::size_t c = 0; c < one.field->coarse.size(); ++c) {
    ASSERT_EQ(two.field->coarse[c].phi, one.field->coarse[c].phi);
    ASSERT_EQ(two.field->coarse[c].gx, one.field->coarse[c].gx);
  }
}

TEST(MergeFields, ObjectInsideAnotherHasNoEffect) {
  const TriangleMesh big = icosphere(0.03, 16), small = icosphere(0.008, 8);
  const MergedShapes one = mergedShapes({big}), two = mergedShapes({big, small});
  ASSERT_EQ(two.field->block_index, one.field->block_index);
  for (std::size_t s = 0; s < one.field->blockCount(); ++s)
    ASSERT_EQ(two.field->distance[s]->phi(), one.field->distance[s]->phi());
}

TEST(MergeFields, BlocksOfOneObjectAreShared) {
  const MergedShapes m = twoSpheres(0.06);
  std::size_t shared = 0;
  for (const auto& block : m.field->distance)
    for (const FieldPart& part : m.parts)
      shared += static_cast<std::size_t>(
          std::count(part.field->distance.begin(), part.field->distance.end(), block));
  EXPECT_EQ(shared, m.field->blockCount());
}

// T-K14c. A part alone on the lattice and beside others; positions are multiples of 2^-30 m,
// so that the grids' different origins round nothing.
TEST(MergeFields, ObjectDoesNotDependOnNeighboursOrTheirOrder) {
  const TriangleMesh ball = icosphere(0.01, 12);
  const MergedShapes one = mergedShapes({ball});
  const MergedShapes three = mergedShapes(
      {movedBy(ball, Vec3(-0.04, 0.01, 0)), ball, movedBy(ball, Vec3(0.03, -0.05, 0.02))});
  const FieldSampler alone(*one.field, Sampler::high), beside(*three.field, Sampler::high);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-0.012, 0.012);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p =
        0x1p-30 * (0x1p30 * Vec3(u(random), u(random), u(random))).array().round().matrix();
    const GridSample x = alone.at(p), y = beside.at(p);
    if (x.region == FieldRegion::outside) continue; // bounds, not distances
    ASSERT_EQ(x.phi, y.phi);
    ASSERT_EQ(x.gradient, y.gradient);
    ASSERT_EQ(x.region, y.region);
  }
}

// The swept test and the far field need a lower bound.
TEST(MergeFields, OutsideValuesAreLowerBoundsOfTheDistance) {
  const MergedShapes m = mergedShapes({movedBy(icosphere(0.008, 12), Vec3(-0.04, 0, 0)),
                                       movedBy(icosphere(0.012, 12), Vec3(0.03, 0.02, 0))});
  const TriangleTree tree(m.joint);
  const FieldSampler sampler(*m.field, Sampler::kim);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-0.07, 0.07);
  double far = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p(u(random), u(random), u(random));
    const GridSample sample = sampler.at(p);
    if (sample.region != FieldRegion::outside) continue;
    EXPECT_LE(sample.phi, tree.closestPoint(p).distance + 1e-9);
    far = std::max(far, sample.phi);
  }
  EXPECT_GT(far, 0.02); // a useful bound
}

TEST(MergeFields, IncompatiblePartsAreRejected) {
  const MergedShapes m = twoSpheres(0.06);
  EXPECT_THROW((void)mergeFields({}, m.lattice), std::invalid_argument);
  EXPECT_THROW((void)mergeFields(m.parts, {m.lattice.anchor, 2 * m.lattice.voxel}),
               std::invalid_argument);
  std::vector<FieldPart> apart = m.parts;
  apart[1].first_block[0] += 600;
  EXPECT_THROW((void)mergeFields(apart, m.lattice), Error);
}

// This also holds deeper than the band, where only the part's own field counts.
TEST(MergeFields, ReturnsASinglePartUnchanged) {
  for (const double band : {4.0, 6.0}) {
    const MergedShapes m = mergedShapes({icosphere(0.03, 6)}, 0x1p-9, false, band);
    const auto alone = withSamples(m.parts[0].field);
    const FieldSampler part(*alone, Sampler::high), merged(*m.field, Sampler::high);
    for (double z = 0; z < 0.04; z += 1e-4) {
      const GridSample a = part.at(Vec3(1e-3, 2e-3, z)), b = merged.at(Vec3(1e-3, 2e-3, z));
      EXPECT_EQ(a.phi, b.phi) << z;
      EXPECT_EQ(a.gradient, b.gradient) << z;
      EXPECT_EQ(a.region, b.region) << z;
    }
  }
}

} // namespace
} // namespace patina
