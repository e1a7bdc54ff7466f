// F9: after re-distancing, the depth of a union is the distance to its own surface.
#include "field/merge/redistance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "field/merge/union_surface.h"
#include "field/merged_shapes.h"
#include "field/sampling/field_sampler.h"
#include "geometry/tree/triangle_tree.h"
#include "support/node_values.h"

namespace patina {
namespace {

using test::mergedShapes;
using test::MergedShapes;
using test::movedBy;

constexpr double kR = 0.02, kOff = 0.01;
const double kCrease = std::sqrt(kR * kR - kOff * kOff); // 17.32 mm

std::vector<TriangleMesh> pair() {
  return {movedBy(icosphere(kR, 24), Vec3(-kOff, 0, 0)),
          movedBy(icosphere(kR, 24), Vec3(kOff, 0, 0))};
}

// Built once at h = 2^-11 m, by min alone and re-distanced.
const MergedShapes& thePair(bool redistance = false) {
  static const MergedShapes min = mergedShapes(pair()), exact = mergedShapes(pair(), 0x1p-11, true);
  return redistance ? exact : min;
}

double depthInPair(const Vec3& p) {
  double depth = std::hypot(p.x(), std::hypot(p.y(), p.z()) - kCrease);
  for (const double x : {-kOff, kOff}) {
    const Vec3 from = p - Vec3(x, 0, 0);
    const Vec3 foot = Vec3(x, 0, 0) + kR / from.norm() * from;
    if ((foot + Vec3(x, 0, 0)).norm() >= kR) depth = std::min(depth, std::abs(kR - from.norm()));
  }
  return depth;
}

std::vector<TriangleMesh> bars() {
  return {box(Vec3(0.06, 0.02, 0.06)), box(Vec3(0.02, 0.06, 0.06))};
}

// Two crossing bars of equal length along z.
double depthInCross(const Vec3& p) {
  const double wide = 0.03, narrow = 0.01;
  double depth = wide - std::abs(p.z());
  for (int swap = 0; swap < 2; ++swap) {
    const double x = std::abs(p[swap]), y = std::abs(p[1 - swap]);
    depth = std::min(depth, std::hypot(std::max(narrow - x, 0.0), y - narrow)); // y = narrow
    depth = std::min(depth, std::hypot(std::max(y - narrow, 0.0), wide - x));   // x = wide
  }
  return depth;
}

template <class Depth> double worstNode(const SurfaceField& field, const Depth& depth) {
  double worst = 0;
  for (const auto& at : field.block_at)
    for (int n = 0; n < kBlockNodes; ++n) {
      const std::array<int, 3> i{kBlockSide * at[0] + n % kBlockSide,
                                 kBlockSide * at[1] + n / kBlockSide % kBlockSide,
                                 kBlockSide * at[2] + n / (kBlockSide * kBlockSide)};
      const auto phi = static_cast<double>(test::phiAt(field, i[0], i[1], i[2]));
      if (!(phi < 0)) continue;
      const double exact = depth(field.grid.toWorld(Vec3(i[0], i[1], i[2]))) / field.grid.voxel;
      if (std::abs(phi) < static_cast<double>(kBackground))
        worst = std::max(worst, std::abs(-phi - exact));
      else
        worst = std::max(worst, field.band - exact);
    }
  return worst;
}

template <class Depth> double worstCoarse(const SurfaceField& field, const Depth& depth) {
  double worst = 0;
  std::size_t i = 0;
  for (int z = 0; z <= field.blocks[2]; ++z)
    for (int y = 0; y <= field.blocks[1]; ++y)
      for (int x = 0; x <= field.blocks[0]; ++x, ++i) {
        const auto phi = static_cast<double>(field.coarse[i].phi);
        const double exact =
            depth(field.grid.toWorld(kBlockSide * Vec3(x, y, z))) / field.grid.voxel;
        if (phi < 0) worst = std::max(worst, std::abs(-phi - exact));
      }
  return worst;
}

TEST(Redistance, DepthInTwoSpheresMatchesTheClosedForm) {
  const MergedShapes &before = thePair(), &after = thePair(true);
  EXPECT_GT(worstCoarse(*before.field, depthInPair), 10); // F9: 10 mm for 17.32
  EXPECT_GT(worstNode(*before.field, depthInPair), 1);
  EXPECT_LT(worstNode(*after.field, depthInPair), 0.1); // the bound is h / 2
  EXPECT_LT(worstCoarse(*after.field, depthInPair), 0.1);
  EXPECT_GT(after.redistanced, 1000u);
  EXPECT_LT(after.field->blockCount(), before.field->blockCount());
}

TEST(Redistance, DepthInACrossOfBarsMatchesTheClosedForm) {
  const MergedShapes after = mergedShapes(bars(), 0x1p-11, true);
  EXPECT_GT(worstNode(*mergedShapes(bars()).field, depthInCross), 2);
  EXPECT_LT(worstNode(*after.field, depthInCross), 0.1);
  EXPECT_LT(worstCoarse(*after.field, depthInCross), 0.1);
}

TEST(Redistance, ErrorAtTheCreaseFallsWithTheVoxel) {
  for (const double voxel : {0x1p-9, 0x1p-10, 0x1p-11}) {
    const MergedShapes m = mergedShapes(bars(), voxel, true);
    EXPECT_LT(worstCoarse(*m.field, depthInCross), 0.1) << voxel; // in voxels
  }
}

TEST(Redistance, KeepsEveryNodeThatIsAlreadyExact) {
  const MergedShapes& m = thePair();
  Progress progress;
  const SurfaceField before = mergeFields(m.parts, m.lattice);
  const SurfaceField after = redistanced(before, m.parts, m.lattice, m.joint, progress).field;
  std::size_t same = 0;
  for (std::size_t s = 0; s < before.blockCount(); ++s) {
    const auto& at = before.block_at[s];
    const std::int32_t now = after.slotOf(at[0], at[1], at[2]);
    if (now < 0) continue;
    const auto old_phi = before.distance[s]->phi();
    const auto new_phi = after.distance[static_cast<std::size_t>(now)]->phi();
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      const float phi = old_phi[n];
      if (phi > 0) {
        ASSERT_EQ(new_phi[n], phi);
      } else {
        ASSERT_LE(new_phi[n], phi); // deeper or the same
      }
    }
    same += before.distance[s] == after.distance[static_cast<std::size_t>(now)];
  }
  EXPECT_GT(same, before.blockCount() / 2); // shared, not copied
}

TEST(Redistance, DisjointOrCoincidentObjectsChangeNothing) {
  const MergedShapes apart = mergedShapes({movedBy(icosphere(0.01, 12), Vec3(-0.02, 0, 0)),
                                           movedBy(icosphere(0.01, 12), Vec3(0.02, 0, 0))},
                                          0x1p-11, true);
  EXPECT_EQ(apart.redistanced, 0u);
  const MergedShapes twice =
      mergedShapes({icosphere(0.02, 12), icosphere(0.02, 12)}, 0x1p-11, true);
  EXPECT_EQ(twice.redistanced, 0u);
  const std::vector<TriangleMesh> boxes{box(Vec3(0.05, 0.06, 0.04)), box(Vec3(0.05, 0.06, 0.04))};
  const MergedShapes before = mergedShapes(boxes, 0x1p-10),
                     after = mergedShapes(boxes, 0x1p-10, true);
  EXPECT_EQ(after.field->block_index,
            before.field->block_index); // blocks with a single face count too
}

// A sheet whose front is `front` voxels high and a cube that penetrates it: the depth below the
// cube is that to the sheet's back, or to where the cube's sides leave the front.
TEST(Redistance, IncludesTheBackOfAThickenedSheet) {
  const double voxel = 0x1p-10;
  for (const int front : {0, -2}) {
    const TriangleMesh plate = movedBy(sheet(60 * voxel, 60 * voxel, 6), Vec3(0, 0, front * voxel));
    const TriangleMesh cube =
        movedBy(box(Vec3::Constant(20 * voxel), 4), Vec3(0, 0, (front + 8) * voxel));
    const MergedShapes before = mergedShapes({plate, cube}, voxel);
    const MergedShapes after = mergedShapes({plate, cube}, voxel, true);
    const auto phiAt = [&](const SurfaceField& field, int x, int z) {
      const Vec3 at = field.grid.toGrid(voxel * Vec3(x, 0, z));
      return test::phiAt(field, static_cast<int>(std::lround(at.x())),
                         static_cast<int>(std::lround(at.y())),
                         static_cast<int>(std::lround(at.z())));
    };
    for (const int x : {-3, 0, 5})
      for (int depth = 1; depth < 8; ++depth)
        EXPECT_NEAR(-phiAt(*after.field, x, front - depth),
                    std::min(8.0 - depth, std::hypot(10 - std::abs(x), depth)), 1.5 * kHiddenFrom)
            << x << ' ' << depth;
    for (const int x : {-3, 0, 5, 20})
      for (int depth = 5; depth < 12; ++depth)
        EXPECT_EQ(phiAt(*after.field, x, front - depth), phiAt(*before.field, x, front - depth))
            << x << ' ' << depth;
    std::size_t i = 0, judged = 0;
    for (int z = 0; z <= after.field->blocks[2]; ++z)
      for (int y = 0; y <= after.field->blocks[1]; ++y)
        for (int x = 0; x <= after.field->blocks[0]; ++x, ++i) {
          const Vec3 p =
              after.field->grid.toWorld(kBlockSide * Vec3(x, y, z)) / voxel - Vec3(0, 0, front);
          if (std::max(std::abs(p.x()), std::abs(p.y())) > 20 || !(p.z() < -4 && p.z() > -8))
            continue;
          EXPECT_NEAR(after.field->coarse[i].phi, -8 - p.z(), 0.01) << p.transpose();
          ++judged;
        }
    EXPECT_EQ(judged > 0, front == -2);
  }
}

TEST(Redistance, UnionSurfaceAreaMatchesTheClosedForm) {
  const MergedShapes& m = thePair();
  Progress progress;
  const UnionSurface surface = unionSurface(m.parts, m.lattice, m.joint, progress);
  const double cap =
      4 * M_PI * kR * kR - 2 * M_PI * kR * (kR - kOff); // a sphere less the hidden cap
  EXPECT_NEAR(area(surface.mesh) / (2 * cap), 1, 2e-3);
  ASSERT_EQ(surface.face.size(), surface.mesh.triangles.size());
}

TEST(Redistance, ThrowsIfCancelled) {
  const MergedShapes& m = thePair();
  Progress progress;
  progress.cancel();
  EXPECT_THROW(
      (void)redistanced(mergeFields(m.parts, m.lattice), m.parts, m.lattice, m.joint, progress),
      Cancelled);
}

// The blended gradient vanishes at the centre; the corners' own closest points do not.
TEST(InteriorClosestPoints, FindTheCreaseFromTheCentreOfTwoSpheres) {
  const MergedShapes m = mergedShapes(pair(), 0.07 / 134, true);
  const FieldSampler sampler(*m.field, Sampler::high);
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1e-4, 0, 0), Vec3(0, 1e-4, 0), Vec3(-7e-5, 0, 7e-5)}) {
    const auto feet = sampler.interiorClosestPoints(m.field->grid.toGrid(p));
    ASSERT_TRUE(feet);
    EXPECT_TRUE(feet->opposed);
    EXPECT_NEAR((m.field->grid.toWorld(feet->nearest) - p).norm(), kCrease, m.lattice.voxel);
  }
  const auto aside = sampler.interiorClosestPoints(m.field->grid.toGrid(Vec3(0, 0.007, 0)));
  ASSERT_TRUE(aside);
  EXPECT_FALSE(aside->opposed);
  EXPECT_FALSE(sampler.interiorClosestPoints(Vec3(-100, 0, 0)));
  EXPECT_FALSE(sampler.interiorClosestPoints(Vec3::Constant(std::nan(""))));
}

// A bar crosses the end of a longer one; both fields are longer than high.
TEST(Redistance, UnionSurfaceOmitsTheHiddenEndOfALongPart) {
  const TriangleMesh post = box(Vec3(0.02, 0.06, 0.02), 2);
  const TriangleMesh bar = movedBy(box(Vec3(0.04, 0.01, 0.01), 4), Vec3(0, 0.022, 0));
  const MergedShapes m = mergedShapes({post, bar}, 0x1p-10);
  Progress progress;
  const double own = area(post) + area(bar), hidden = 4 * 0.02 * 0.01 + 2 * 0.01 * 0.01;
  EXPECT_NEAR(area(unionSurface(m.parts, m.lattice, m.joint, progress).mesh), own - hidden,
              0.02 * hidden);
}

} // namespace
} // namespace patina
