#include "field/signs/sign_slivers.h"

#include <cmath>

#include <gtest/gtest.h>

#include "field/construction/distance_blocks.h"
#include "geometry/mesh/shapes.h"

namespace patina::signs {
namespace {

struct Neighbour {
  NodePlace place;
  Vec3 step;
  double margin;
};

// All deeper ones of the 26 neighbours of a node.
std::vector<Neighbour> deeperAbout(const FieldBuilder& builder, const Index3& at, float depth) {
  const SurfaceField& field = builder.field;
  std::vector<Neighbour> result;
  for (int n = 0; n < 27; ++n) {
    const Index3 step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    const Index3 to{at[0] + step[0], at[1] + step[1], at[2] + step[2]};
    bool in_grid = n != 13;
    for (std::size_t a = 0; a < 3; ++a)
      in_grid = in_grid && to[a] >= 0 && to[a] < kBlockSide * field.blocks[a];
    if (!in_grid) continue;
    const BlockNode node = BlockNode::of(to);
    const auto& b = node.block;
    NodePlace place;
    place.top_index =
        static_cast<std::size_t>((b[2] * field.blocks[1] + b[1]) * field.blocks[0] + b[0]);
    place.slot = field.block_index[place.top_index] < 0 ? -1 : field.block_index[place.top_index];
    place.node = node.node;
    const double d =
        place.slot < 0
            ? field.band
            : double{builder.distance[static_cast<std::size_t>(place.slot)]->phi()[node.node]};
    const Vec3 way(step[0], step[1], step[2]);
    if (d > double{depth}) result.push_back({place, way, double{depth} + d - way.norm()});
  }
  return result;
}

// Gaps and walls of about a voxel, where many nodes see no other node.
TEST(Slivers, FindDeeperNodeByDistanceOrFreeSegment) {
  std::size_t by_distance = 0, by_sight = 0, none = 0;
  for (const double band : {1.2, 4.0}) {
    TriangleMesh mesh = icosphere(0.01, 2);
    for (const double shift : {0.0007, 0.0013, 0.0101}) {
      const TriangleMesh ball = icosphere(0.01, 2);
      const auto first = static_cast<std::int32_t>(mesh.positions.size());
      for (const Vec3& p : ball.positions) mesh.positions.push_back(p + Vec3(shift, -shift, shift));
      for (const Triangle& t : ball.triangles)
        mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    const TriangleTree tree(mesh);
    Progress progress;
    FieldSpec spec;
    spec.voxel = 0.001;
    spec.band = band;
    const FieldBuilder builder =
        distanceBlocks(mesh, tree, gridAround(bounds(mesh), spec), band, progress, 0, 1);
    NearbyBlocks blocks(builder);
    for (std::size_t slot = 0; slot < builder.distance.size(); ++slot)
      for (std::size_t n = 0; n < kBlockNodes; ++n) {
        const float depth = builder.distance[slot]->phi()[n];
        if (!(depth < kBackground)) continue;
        const auto s = static_cast<std::int32_t>(slot);
        const Index3 at = nodeAt(builder, s, n);
        const Vec3 p = builder.field.grid.toWorld(Vec3(at[0], at[1], at[2]));
        const auto inSight = [&](const Neighbour& to) {
          return !tree.firstHit(p, to.step, to.step.norm() * builder.field.grid.voxel);
        };
        std::vector<Neighbour> deeper = deeperAbout(builder, at, depth);
        std::stable_sort(deeper.begin(), deeper.end(),
                         [](auto& a, auto& b) { return a.margin > b.margin; });
        NodePlace found;
        if (visibleDeeperNode(blocks, tree, s, n, found)) {
          const auto seen = std::find_if(deeper.begin(), deeper.end(), [&](const Neighbour& to) {
            return to.place.top_index == found.top_index && to.place.node == found.node;
          });
          ASSERT_NE(seen, deeper.end());
          ASSERT_EQ(found.slot, seen->place.slot);
          if (seen->margin > 1e-3)
            ++by_distance;
          else
            ++by_sight;
          ASSERT_TRUE(seen->margin > 0.99e-3 || inSight(*seen));
        } else {
          ++none;
          for (const Neighbour& to : deeper) ASSERT_LE(to.margin, 1.01e-3);
          // The four likeliest directions are blocked.
          for (std::size_t i = 0; i < std::min<std::size_t>(deeper.size(), 4); ++i)
            if (i + 1 == deeper.size() || deeper[i].margin > deeper[i + 1].margin + 1e-6)
              ASSERT_FALSE(inSight(deeper[i]));
            else
              break; // rounding decides between two equal ones
        }
      }
  }
  EXPECT_GT(by_distance, 1000U);
  EXPECT_GT(by_sight, 20U);
  EXPECT_GT(none, 20U);
}

} // namespace
} // namespace patina::signs
