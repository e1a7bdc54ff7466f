#include "field/store/surface_field.h"

#include <atomic>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "field/analytic_fields.h"
#include "support/node_values.h"

namespace patina {
namespace {

using namespace test;

constexpr double kRadius = 0.05;

TEST(SampledFunction, StoresEveryBandNodeAndTheSignOfAllOthers) {
  const FieldGrid grid = cubeGrid(kRadius, 64, 5);
  const Distance sphere = sphereDistance(kRadius);
  const SurfaceField field = sampleFunction(sphere, grid, 5);
  for (int k = 0; k < grid.nodes[2]; ++k)
    for (int j = 0; j < grid.nodes[1]; ++j)
      for (int i = 0; i < grid.nodes[0]; ++i) {
        const double exact = sphere(grid.toWorld(Vec3(i, j, k))) / grid.voxel;
        const float stored = test::phiAt(field, i, j, k);
        if (std::abs(exact) <= 5)
          ASSERT_NEAR(stored, exact, 1e-6);
        else
          ASSERT_EQ(stored, exact < 0 ? -kBackground : kBackground) << i << ' ' << j << ' ' << k;
      }
  EXPECT_EQ(test::phiAt(field, -1, 0, 0), kBackground);
  EXPECT_EQ(test::phiAt(field, 0, 0, grid.nodes[2]), kBackground);
  EXPECT_EQ(field.faceAt(32, 32, 6), -1);
}

TEST(SampledFunction, StoresNoBlockWithoutABandNodeAndSkipsDistantBlocks) {
  const FieldGrid grid = cubeGrid(kRadius, 150, 4);
  std::atomic<std::size_t> calls{0};
  const SurfaceField field = sampleFunction(
      [&](const Vec3& p) {
        ++calls;
        return p.norm() - kRadius;
      },
      grid, 4);
  EXPECT_LT(calls.load(), grid.nodeCount() / 2);
  for (const auto& block : field.distance) {
    bool any = false;
    for (const float phi : block->phi()) any |= std::abs(phi) <= 4;
    EXPECT_TRUE(any);
  }
  std::size_t stored = 0;
  for (const std::int32_t slot : field.block_index) stored += slot >= 0;
  EXPECT_EQ(stored, field.blockCount());
  for (std::size_t slot = 0; slot < field.blockCount(); ++slot) {
    const auto& at = field.block_at[slot];
    EXPECT_EQ(field.slotOf(at[0], at[1], at[2]), static_cast<std::int32_t>(slot));
  }
}

TEST(SampledFunction, CoarseNodesLieAtBlockCorners) {
  const FieldGrid grid = cubeGrid(kRadius, 60);
  const Distance sphere = sphereDistance(kRadius);
  const SurfaceField field = sampleFunction(sphere, grid, 8);
  ASSERT_EQ(field.coarse.size(), 9U * 9U * 9U);
  const CoarseNode& node = field.coarse[(2 * 9 + 5) * 9 + 7];
  const Vec3 p = grid.toWorld(8.0 * Vec3(7, 5, 2));
  EXPECT_NEAR(node.phi, sphere(p) / grid.voxel, 1e-5);
  EXPECT_LT(angleBetween(Vec3(node.gx, node.gy, node.gz), p), 1e-3);
}

// K04, against differences taken node by node.
TEST(SampleLayer, GradientsAreCentralAndOneSidedBesideTheBandsEnd) {
  const FieldGrid grid = cubeGrid(kRadius, 50, 4);
  const auto field = sampledField(torusDistance(0.03, 0.015), grid, 4);
  const auto difference = [&](int i, int j, int k, int axis) {
    const std::array<int, 3> d{axis == 0, axis == 1, axis == 2};
    const float before = test::phiAt(*field, i - d[0], j - d[1], k - d[2]);
    const float here = test::phiAt(*field, i, j, k);
    const float after = test::phiAt(*field, i + d[0], j + d[1], k + d[2]);
    const bool low = std::abs(before) < kBackground, high = std::abs(after) < kBackground;
    if (low && high) return (after - before) / 2;
    return high ? after - here : low ? here - before : 0.0F;
  };
  std::size_t one_sided = 0, central_ones = 0, nodes = 0;
  for (std::size_t slot = 0; slot < field->blockCount(); ++slot) {
    const auto& at = field->block_at[slot];
    for (int z = 0; z < kSampleSide; ++z)
      for (int y = 0; y < kSampleSide; ++y)
        for (int x = 0; x < kSampleSide; ++x) {
          const int i = 8 * at[0] + x, j = 8 * at[1] + y, k = 8 * at[2] + z;
          if (i + 1 >= grid.nodes[0] || j + 1 >= grid.nodes[1] || k + 1 >= grid.nodes[2]) continue;
          const SampleNode& node =
              field->sample[slot]
                  ->node[static_cast<std::size_t>((z * kSampleSide + y) * kSampleSide + x)];
          ASSERT_EQ(node.phi, test::phiAt(*field, i, j, k));
          if (std::abs(node.phi) >= kBackground) {
            ASSERT_EQ(node.gx, 0);
            continue;
          }
          const Vec3 central(difference(i, j, k, 0), difference(i, j, k, 1),
                             difference(i, j, k, 2));
          one_sided += std::abs(test::phiAt(*field, i + 1, j, k)) >= kBackground;
          ASSERT_LT((Vec3(node.gx, node.gy, node.gz) - central).norm(), 0.2);
          ++nodes;
          // Neighbours across the crease have nearly the same slopes and contribute to these.
          central_ones += (Vec3(node.gx, node.gy, node.gz) - central).norm() < 5e-3;
        }
  }
  EXPECT_GT(one_sided, 100U);
  // The others lie near the circle in the middle of the tube, where the distance has a crease.
  EXPECT_GT(static_cast<double>(central_ones), 0.5 * static_cast<double>(nodes));
}

// Near a crease a central difference is the slope of neither side; a node holds that of its own.
// Near an inner corner of three planes, the distance is the smallest of the three.
TEST(SampleLayer, NodeBesideACreaseHoldsTheSlopeOfItsOwnSide) {
  const Eigen::Matrix3d normals =
      Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto corner = [&](const Vec3& p) { return (normals.transpose() * p).minCoeff(); };
  const auto field = sampledField(corner, cubeGrid(kRadius, 50, 4), 6);
  std::size_t own = 0, beside = 0;
  double worst = 0;
  for (std::size_t slot = 0; slot < field->blockCount(); ++slot)
    for (int n = 0; n < kBlockSide * kBlockSide * kBlockSide; ++n) {
      const int x = n % 8, y = n / 8 % 8, z = n / 64;
      const auto& at = field->block_at[slot];
      const Vec3 q(8 * at[0] + x, 8 * at[1] + y, 8 * at[2] + z);
      const SampleNode& node =
          field->sample[slot]
              ->node[static_cast<std::size_t>((z * kSampleSide + y) * kSampleSide + x)];
      if (!(std::abs(node.phi) < 4)) continue;
      Vec3 heights = normals.transpose() * field->grid.toWorld(q) / field->grid.voxel;
      Eigen::Index least = 0;
      heights.minCoeff(&least);
      std::sort(heights.begin(), heights.end());
      if (heights[1] - heights[0] > 1.5) continue; // its central difference is right
      ++beside;
      const double error = (Vec3(node.gx, node.gy, node.gz) - normals.col(least)).norm();
      own += error < 0.02;
      worst = std::max(worst, error);
    }
  ASSERT_GT(beside, 500U);
  // The others lie so near the crease that either side is valid.
  EXPECT_GT(static_cast<double>(own), 0.9 * static_cast<double>(beside));
  EXPECT_LT(worst, 1.5);
}

TEST(SampleLayer, FlagsExactlyTheCellsWhoseEightNodesAreStored) {
  const FieldGrid grid = cubeGrid(kRadius, 40, 3);
  const auto field = sampledField(sphereDistance(kRadius), grid, 3);
  std::size_t complete = 0, incomplete = 0;
  for (std::size_t slot = 0; slot < field->blockCount(); ++slot) {
    const auto& at = field->block_at[slot];
    for (int cell = 0; cell < kBlockNodes; ++cell) {
      const int x = cell % 8, y = cell / 8 % 8, z = cell / 64;
      const int i = 8 * at[0] + x, j = 8 * at[1] + y, k = 8 * at[2] + z;
      if (i + 1 >= grid.nodes[0] || j + 1 >= grid.nodes[1] || k + 1 >= grid.nodes[2]) continue;
      bool all = true;
      for (int corner = 0; corner < 8; ++corner)
        all &= std::abs(test::phiAt(*field, i + (corner & 1), j + (corner >> 1 & 1),
                                    k + (corner >> 2))) < kBackground;
      ASSERT_EQ(field->sample[slot]->cellComplete(x, y, z), all) << i << ' ' << j << ' ' << k;
      ++(all ? complete : incomplete);
    }
  }
  EXPECT_GT(complete, 1000U);
  EXPECT_GT(incomplete, 1000U);
}

TEST(SampleLayer, SharesTheOtherLayersAndIsIdempotent) {
  const auto bare = std::make_shared<const SurfaceField>(
      sampleFunction(sphereDistance(kRadius), cubeGrid(kRadius, 40), 8));
  const auto field = withSamples(bare);
  EXPECT_EQ(field->distance[0], bare->distance[0]);
  EXPECT_TRUE(bare->sample.empty());
  EXPECT_EQ(withSamples(field), field);
}

TEST(LayerBytes, CountOnlyTheLayersThatExist) {
  const auto bare = std::make_shared<const SurfaceField>(
      sampleFunction(sphereDistance(kRadius), cubeGrid(kRadius, 40), 8));
  const auto sizes = [](const SurfaceField& field) {
    std::map<std::string, std::size_t> bytes;
    for (const LayerBytes& layer : field.layerBytes()) bytes[layer.name] = layer.bytes;
    return bytes;
  };
  const auto without = sizes(*bare);
  EXPECT_EQ(without.count("sample"), 0U);
  EXPECT_EQ(without.count("face"), 0U);
  EXPECT_GE(without.at("distance"), bare->blockCount() * sizeof(DistanceBlock));
  const auto field = withSamples(bare);
  EXPECT_GE(sizes(*field).at("sample"), field->blockCount() * sizeof(SampleBlock));
  std::size_t sum = 0;
  for (const auto& [name, size] : sizes(*field)) sum += size;
  EXPECT_EQ(field->bytes(), sum);
}

// The value beyond the last block of the band is the end mark, not a surface.
TEST(SampleLayer, MatchesTheDataOfEachNode) {
  FieldGrid grid;
  grid.voxel = 1;
  grid.nodes = {17, 17, 33};
  const auto field = sampledField([](const Vec3& p) { return p.z() - 11.5; }, grid, 3);
  for (std::size_t slot = 0; slot < field->blockCount(); ++slot)
    for (int n = 0; n < kSampleSide * kSampleSide * kSampleSide; ++n) {
      const auto& at = field->block_at[slot];
      const int i = 8 * at[0] + n % 9, j = 8 * at[1] + n / 9 % 9, k = 8 * at[2] + n / 81;
      if (i > 16 || j > 16 || k > 32) continue;
      const SampleNode& node = field->sample[slot]->node[static_cast<std::size_t>(n)];
      ASSERT_EQ(node.phi, test::phiAt(*field, i, j, k)) << i << ' ' << j << ' ' << k;
      if (std::abs(node.phi) < kBackground) {
        ASSERT_EQ(Vec3(node.gx, node.gy, node.gz), Vec3(0, 0, 1)) << i << ' ' << j << ' ' << k;
      }
    }
}

} // namespace
} // namespace patina
