#include "field/construction/edit_field.h"

#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "field/analytic_fields.h"
#include "support/node_values.h"

namespace patina {
namespace {

using namespace test;

bool isStored(float phi) {
  return std::abs(phi) < kBackground;
}

// K04, one node at a time.
float difference(const SurfaceField& field, const std::array<int, 3>& at, std::size_t axis) {
  auto low = at, high = at;
  --low[axis];
  ++high[axis];
  const auto phi = [&](const std::array<int, 3>& n) {
    return test::phiAt(field, n[0], n[1], n[2]);
  };
  const float before = phi(low), here = phi(at), after = phi(high);
  if (isStored(before) && isStored(after)) return (after - before) * 0.5F;
  if (isStored(after)) return after - here;
  return isStored(before) ? here - before : 0;
}

// Mean of the nine parallel differences if all neighbours are stored and no difference belongs to a
// different slope than the node's own.
float slope(const SurfaceField& field, const std::array<int, 3>& at, std::size_t axis) {
  const float own = difference(field, at, axis);
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  float sum = 0;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      auto beside = at;
      beside[u] += i;
      beside[v] += j;
      for (int k = -1; k <= 1; ++k) {
        auto node = beside;
        node[axis] += k;
        if (!isStored(test::phiAt(field, node[0], node[1], node[2]))) return own;
      }
      const float other = difference(field, beside, axis);
      if (!(std::abs(other - own) < 0.03F)) return own;
      sum += other * (i == 0 ? 4.F : 1.F) * (j == 0 ? 4.F : 1.F) / 36.F;
    }
  return sum;
}

// A grid of whole blocks, so that test::phiAt() covers every stored node.
FieldGrid wholeBlocks() {
  return {Vec3::Constant(-0.04), 1e-3, {80, 80, 80}};
}

TEST(SampleLayer, HoldsEachNodesOwnDifferences) {
  const auto field = sampledField(sphereDistance(0.025), wholeBlocks(), 4);
  std::size_t complete = 0, nodes = 0;
  for (std::size_t slot = 0; slot < field->blockCount(); ++slot) {
    const auto& block = field->block_at[slot];
    const SampleBlock& sample = *field->sample[slot];
    for (int z = 0; z < kSampleSide; ++z)
      for (int y = 0; y < kSampleSide; ++y)
        for (int x = 0; x < kSampleSide; ++x, ++nodes) {
          const std::array<int, 3> at{kBlockSide * block[0] + x, kBlockSide * block[1] + y,
                                      kBlockSide * block[2] + z};
          const SampleNode& node =
              sample.node[static_cast<std::size_t>((z * kSampleSide + y) * kSampleSide + x)];
          const float phi = test::phiAt(*field, at[0], at[1], at[2]);
          ASSERT_EQ(node.phi, phi);
          Vec3 central = Vec3::Zero(), expected = Vec3::Zero();
          for (std::size_t axis = 0; isStored(phi) && axis < 3; ++axis) {
            central[static_cast<Eigen::Index>(axis)] = difference(*field, at, axis);
            expected[static_cast<Eigen::Index>(axis)] = slope(*field, at, axis);
          }
          // The distance has a crease at the centre; a node near it takes its own side's slope.
          const double tolerance =
              isStored(phi) && std::abs(central.squaredNorm() - 1) > 9e-4 ? 0.2 : 2e-6;
          ASSERT_LE((Vec3(node.gx, node.gy, node.gz) - expected).norm(), tolerance);
          if (x == kBlockSide || y == kBlockSide || z == kBlockSide) continue;
          bool all = true;
          for (int c = 0; c < 8; ++c)
            all = all && isStored(test::phiAt(*field, at[0] + (c & 1), at[1] + (c >> 1 & 1),
                                              at[2] + (c >> 2)));
          ASSERT_EQ(sample.cellComplete(x, y, z), all);
          complete += all;
        }
  }
  EXPECT_GT(complete, nodes / 10);
  EXPECT_LT(complete, nodes / 2);
}

bool sameSamples(const SurfaceField& a, const SurfaceField& b) {
  for (std::size_t slot = 0; slot < a.blockCount(); ++slot)
    if (std::memcmp(a.sample[slot].get(), b.sample[slot].get(), sizeof(SampleBlock)) != 0)
      return false;
  return true;
}

TEST(RenewSamples, EqualsTheWholeFieldAndSharesUnchangedBlocks) {
  const auto original = sampledField(sphereDistance(0.025), wholeBlocks(), 4);
  std::mt19937 random(3);
  SurfaceField field = *original;
  for (int edit = 0; edit < 20; ++edit) {
    const SurfaceField before = field;
    const auto slot = static_cast<std::int32_t>(random() % field.blockCount());
    auto& block = field.distance[static_cast<std::size_t>(slot)];
    DistanceNodes nodes{block->phi()};
    for (float& phi : nodes.phi)
      if (isStored(phi)) phi += 0.25F;
    block = std::make_shared<const DistanceBlock>(nodes);
    updateSamples(field, std::array{slot}, *original);
    SurfaceField bare = field;
    bare.sample.clear();
    ASSERT_TRUE(
        sameSamples(field, *withSamples(std::make_shared<const SurfaceField>(std::move(bare)))));
    std::size_t renewed = 0;
    for (std::size_t s = 0; s < field.blockCount(); ++s)
      renewed += field.sample[s] != before.sample[s];
    EXPECT_GE(renewed, 1U);
    EXPECT_LE(renewed, 27U);
  }
  std::vector<std::int32_t> all(field.blockCount());
  for (std::size_t s = 0; s < all.size(); ++s) all[s] = static_cast<std::int32_t>(s);
  field.distance = original->distance;
  updateSamples(field, all, *original);
  EXPECT_EQ(field.sample, original->sample);
}

} // namespace
} // namespace patina
