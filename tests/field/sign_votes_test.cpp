// Votes on the side of a node, and the nodes that stay ambiguous. A voxel is a metre here.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "field/construction/build_field.h"
#include "field/construction/distance_blocks.h"
#include "field/signs/signs.h"
#include "field/store/node_reader.h"
#include "field/surface/iso_surface.h"
#include "geometry/mesh/shapes.h"
#include "support/changed_mesh.h"

namespace patina {
namespace {

using test::moved;

double distanceToBox(const Vec3& p, const Vec3& half) {
  const Vec3 q = p.cwiseAbs() - half;
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

// Most of the body lies near its surface and has no vote.
TEST(SignVotes, DeepPartOfABodyDecidesForItsThinPart) {
  const auto disc = [](const Vec3& p) {
    return std::min(distanceToBox(p, Vec3(20, 20, 1.6)), p.norm() - 6);
  };
  const FieldGrid grid{Vec3(-28, -28, -14), 1, {57, 57, 29}};
  Progress progress;
  const TriangleMesh mesh = isoSurface(sampleFunction(disc, grid, 4), 0);
  const BuiltField built = buildField(mesh, grid, 4, progress);
  NodeReader nodes(*built.field);
  std::size_t inside = 0;
  for (int k = 0; k < 29; ++k)
    for (int j = 0; j < 57; ++j)
      for (int i = 0; i < 57; ++i) {
        const double truth = disc(grid.toWorld(Vec3(i, j, k)));
        if (std::abs(truth) < 0.5) continue;
        EXPECT_EQ(nodes.phiAt(i, j, k) < 0, truth < 0) << i << ' ' << j << ' ' << k;
        inside += truth < 0;
      }
  EXPECT_GT(inside, 4000U);
  EXPECT_EQ(built.report.ambiguous_signs, 0U);
}

// The layer between the box's bottom and the sheet is nearest to the sheet, and neither of the
// sheet's sides determines the side of the box.
TEST(SignVotes, OpenFaceContradictsNoVote) {
  const TriangleMesh mesh =
      joined(box(Vec3(25, 25, 20), 5), moved(sheet(25, 25, 5), Vec3(0, 0, -8.4)));
  const FieldGrid grid{Vec3(-20, -20, -17.15), 1, {41, 41, 37}};
  Progress progress;
  for (const bool turned : {false, true}) {
    const BuiltField built =
        buildField(turned ? test::inverted(mesh) : mesh, grid, 4, progress, OpenSides::two);
    EXPECT_EQ(built.report.open_triangles, 50U);
    NodeReader nodes(*built.field);
    for (int i = 8; i <= 32; ++i)
      for (int j = 8; j <= 32; ++j) EXPECT_NEAR(nodes.phiAt(i, j, 8), -0.5, 0.26) << i << ' ' << j;
    EXPECT_EQ(built.report.ambiguous_signs, 0U);
  }
}

// A disc one layer of nodes thick; by the winding number half of it is inside, as beside a hole.
TEST(SignVotes, MinorityNodesOfAThinLayerAreAmbiguous) {
  const TriangleMesh disc = box(Vec3(25, 25, 1.6), 5),
                     half = moved(box(Vec3(15, 25, 1.6)), Vec3(-5, 0, 0));
  const TriangleTree tree(disc);
  const FieldGrid grid{Vec3(-20, -20, -8), 1, {41, 41, 17}};
  Progress progress;
  FieldBuilder builder = distanceBlocks(disc, tree, grid, 4, progress, 0, 1);
  const std::size_t doubtful =
      assignSigns(builder, disc, tree, WindingNumber(half), {}, 0, progress);
  EXPECT_GT(doubtful, 0U);
  EXPECT_LT(doubtful, 25U * 25 / 2);
}

} // namespace
} // namespace patina
