#include "field/store/packed_distance.h"

#include <bit>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "field/build/build_field.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

std::array<std::uint32_t, kBlockNodes> bitsOf(const std::array<float, kBlockNodes>& phi) {
  return std::bit_cast<std::array<std::uint32_t, kBlockNodes>>(phi);
}

void expectKept(const DistanceNodes& nodes) {
  ASSERT_EQ(bitsOf(DistanceBlock(nodes).phi()), bitsOf(nodes.phi));
}

// Any bits of a finite float, and any share of nodes beyond the band on either side.
TEST(DistanceBlock, GivesBackEveryBitOfAnyNodes) {
  std::mt19937 random(5);
  for (const double beyond : {0.0, 0.02, 0.5, 0.98, 1.0})
    for (const double inside : {0.0, 0.5, 1.0})
      for (int round = 0; round < 40; ++round) {
        DistanceNodes nodes;
        for (float& phi : nodes.phi) {
          do phi = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
          while (!(std::abs(phi) < kBeyondBand));
          if (std::bernoulli_distribution(beyond)(random))
            phi = std::bernoulli_distribution(inside)(random) ? -kBeyondBand : kBeyondBand;
        }
        expectKept(nodes);
      }
}

// Four nodes of one width and four of another, wherever in a word they begin.
TEST(DistanceBlock, KeepsDifferencesOfEveryWidthBesideAnyOther) {
  std::mt19937 random(7);
  for (unsigned width = 0; width <= 30; ++width)
    for (unsigned other = 0; other <= 30; ++other) {
      DistanceNodes nodes;
      for (std::size_t n = 0; n < kBlockNodes; ++n) {
        const unsigned bits = std::bernoulli_distribution(0.5)(random) ? width : other;
        const std::uint64_t noise = random() & ((std::uint64_t{1} << bits) - 1);
        // From 4 voxels on, through larger numbers, but never to one that is not finite.
        nodes.phi[n] = std::bit_cast<float>(
            static_cast<std::uint32_t>(std::bit_cast<std::uint32_t>(4.0F) + noise % 0x3E000000U));
      }
      expectKept(nodes);
    }
}

TEST(DistanceBlock, KeepsTheSignOfZeroAndTheSmallestNumbers) {
  DistanceNodes nodes;
  for (std::size_t n = 0; n < kBlockNodes; ++n) {
    const float values[] = {0.0F, -0.0F, 1e-45F, -1e-45F, 1e-38F, 8.0F, -8.0F, -1e-30F};
    nodes.phi[n] = values[n * 2654435769U >> 16 & 7U];
  }
  expectKept(nodes);
  for (const float value : {0.0F, -0.0F, kBeyondBand, -kBeyondBand}) {
    nodes.phi.fill(value);
    expectKept(nodes);
  }
}

DistanceNodes sampled(const std::function<double(double, double, double)>& phi) {
  DistanceNodes nodes;
  for (int n = 0; n < kBlockNodes; ++n)
    nodes.phi[static_cast<std::size_t>(n)] =
        static_cast<float>(phi(n % kBlockSide, n / kBlockSide % kBlockSide, n / 64));
  return nodes;
}

// Whatever way it faces a plane is what its rows lead to, but for their rounding.
TEST(DistanceBlock, HoldsAPlaneInAFewBitsANode) {
  for (const Vec3& n :
       {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 2, 3), Vec3(-3, 1, 2)}) {
    const Vec3 u = n.normalized();
    const DistanceBlock block(
        sampled([&](double x, double y, double z) { return u.dot(Vec3(x, y, z)) + 0.3; }));
    EXPECT_LE(block.bytes(), 600U) << n.transpose(); // 2048 unpacked
  }
}

// Noise is what it cannot foresee: then it may be little more than the nodes themselves.
TEST(DistanceBlock, IsAtMostATwelfthLargerThanItsNodes) {
  std::mt19937 random(3);
  DistanceNodes nodes;
  for (float& phi : nodes.phi) phi = std::uniform_real_distribution<float>(-1e6F, 1e6F)(random);
  EXPECT_LE(12 * DistanceBlock(nodes).bytes(), 13 * sizeof(DistanceNodes));
}

} // namespace
} // namespace patina
