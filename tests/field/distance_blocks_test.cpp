// Coarse nodes where several feet are as near.
#include "field/build/distance_blocks.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

// A box half as deep along `axis`, its middle `off` voxels from a block's corner. Unsigned, as
// before the signs.
CoarseNode middleNode(const TriangleMesh& box, int axis, double off) {
  FieldGrid grid;
  grid.voxel = 1;
  grid.origin = Vec3::Constant(-16) + off * Vec3::Unit(axis);
  grid.nodes = {33, 33, 33};
  Progress progress;
  const FieldBuilder builder = distanceBlocks(box, TriangleTree(box), grid, 1, progress, 0, 1);
  const auto n = static_cast<std::size_t>(builder.field.blocks[0]) + 1;
  return builder.field.coarse[(2 * n + 2) * n + 2];
}

Vec3 flat(int axis) {
  return Vec3::Constant(24) - 12 * Vec3::Unit(axis);
}

// Which face comes first in the mesh, and which of the two is nearer by a hair, is no matter.
TEST(CoarseNodes, BetweenTwoFacesHaveNoDirection) {
  const auto expectNone = [](const TriangleMesh& box, int axis, double off) {
    const CoarseNode node = middleNode(box, axis, off);
    EXPECT_NEAR(node.phi, 6 - std::abs(off), 1e-5);
    EXPECT_LT(Vec3(node.gx, node.gy, node.gz).norm(), 1e-5) << axis << ' ' << off;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double off : {-0.02, 0.02}) expectNone(box(flat(axis)), axis, off);
  TriangleMesh turned = box(flat(2));
  for (std::size_t first = 0; first < turned.triangles.size(); ++first) {
    std::rotate(turned.triangles.begin(), turned.triangles.begin() + 1, turned.triangles.end());
    expectNone(turned, 2, 0.02);
  }
}

TEST(CoarseNodes, NearerToOneOfTwoFacesPointAwayFromIt) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double off : {-0.3, 0.3}) {
      const CoarseNode node = middleNode(box(flat(axis)), axis, off);
      const Vec3 away = (off > 0 ? -1 : 1) * Vec3::Unit(axis);
      EXPECT_LT((Vec3(node.gx, node.gy, node.gz) - away).norm(), 1e-5) << axis << ' ' << off;
    }
}

} // namespace
} // namespace patina
