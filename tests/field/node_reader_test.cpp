#include "field/store/node_reader.h"

#include <atomic>

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include "field/analytic_fields.h"
#include "support/node_values.h"

namespace patina {
namespace {

SurfaceField sampledBall() {
  return sampleFunction(test::sphereDistance(0.03), test::cubeGrid(0.05, 60), 4);
}

TEST(NodeReader, ReadsTheNodesInsideAndOutsideTheBand) {
  const SurfaceField field = sampledBall();
  const NodeReader nodes(field);
  std::size_t stored = 0;
  for (int k = -1; k <= field.grid.nodes[2]; k += 3)
    for (int j = -1; j <= field.grid.nodes[1]; ++j)
      for (int i = -1; i <= field.grid.nodes[0]; ++i) {
        const float phi = nodes.phiAt(i, j, k);
        ASSERT_EQ(phi, test::phiAt(field, i, j, k));
        stored += std::abs(phi) < kBackground;
      }
  EXPECT_GT(stored, 1000U);
  EXPECT_EQ(nodes.phiAt(-1, 0, 0), kBackground);
  EXPECT_EQ(nodes.phiAt(30, 30, 30), -kBackground);
}

// Many threads read every block at the same time, and each read is its first.
TEST(NodeReader, ReadsTheSameBlockFromSeveralThreads) {
  const SurfaceField field = sampledBall();
  for (int round = 0; round < 20; ++round) {
    const NodeReader nodes(field);
    std::atomic<std::size_t> wrong{0};
    tbb::parallel_for(std::size_t{0}, 8 * field.blockCount(), [&](std::size_t i) {
      const std::size_t slot = i % field.blockCount();
      wrong += nodes.block(slot).phi != field.distance[slot]->phi();
    });
    ASSERT_EQ(wrong, 0U);
  }
}

} // namespace
} // namespace patina
