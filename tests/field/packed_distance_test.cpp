#include "field/store/surface_field.h"

#include <bit>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "field/construction/build_field.h"
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
TEST(DistanceBlock, RestoresEveryBitOfAnyNodes) {
  std::mt19937 random(5);
  for (const double beyond : {0.0, 0.02, 0.5, 0.98, 1.0})
    for (const double inside : {0.0, 0.5, 1.0})
      for (int round = 0; round < 40; ++round) {
        DistanceNodes nodes;
        for (float& phi : nodes.phi) {
          do phi = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
          while (!(std::abs(phi) < kBackground));
          if (std::bernoulli_distribution(beyond)(random))
            phi = std::bernoulli_distribution(inside)(random) ? -kBackground : kBackground;
        }
        expectKept(nodes);
      }
}

constexpr std::size_t kFours = kBlockNodes / 4;
constexpr std::array<unsigned, 16> kWidths = {0,  2,  4,  6,  8,  10, 12, 14,
                                              16, 18, 20, 22, 24, 26, 28, 32};

// Floats in their order as integers; its own inverse.
std::int32_t ordered(std::int32_t bits) {
  return bits < 0 ? bits ^ 0x7FFFFFFF : bits;
}

// Returns the value predicted from the preceding rows (Lorenzo predictor, Ibarria et al. 2003).
float foreseen(const std::array<float, kBlockNodes>& phi, std::size_t n) {
  const std::size_t y = n / 8 % 8, z = n / 64;
  if (y > 0 && z > 0) return phi[n - 8] + (phi[n - 64] - phi[n - 72]);
  if (y == 0 && z == 0) return 0;
  const std::size_t step = y > 0 ? 8 : 64;
  const float last = phi[n - step];
  return y + z > 1 ? last + (last - phi[n - 2 * step]) : last;
}

// A node whose difference from its prediction takes exactly so many bits; never far from zero.
float nodeOfWidth(float expected, unsigned width, std::mt19937& random) {
  const std::int32_t from = ordered(std::bit_cast<std::int32_t>(expected));
  if (width == 0) return expected;
  const unsigned bits = std::min(width, 30U); // twice the difference, and its sign
  const std::uint32_t least = std::uint32_t{1} << (bits - 2);
  auto by = static_cast<std::int32_t>(least / 2 + 1 + random() % std::max(least / 2, 1U));
  if (from > 0x40000000 || (from > -0x40000000 && random() % 2 == 0)) by = -by;
  return std::bit_cast<float>(ordered(from + by));
}

// Each width precedes each other in the packed order. The bytes show that the widths are right.
TEST(DistanceBlock, KeepsDifferencesOfAnyTwoWidthsSideBySide) {
  std::mt19937 random(7);
  std::set<std::pair<unsigned, unsigned>> met;
  for (int round = 0; round < 40; ++round) {
    std::array<unsigned, kFours> width;
    std::size_t bits = 0;
    for (unsigned& w : width) bits += w = kWidths[random() % kWidths.size()];
    for (std::size_t four = 1; four < kFours; ++four) met.insert({width[four - 1], width[four]});
    DistanceNodes nodes;
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      nodes.phi[n] = nodeOfWidth(foreseen(nodes.phi, n), width[n / 4], random);
      ASSERT_TRUE(std::isfinite(nodes.phi[n]));
    }
    expectKept(nodes);
    EXPECT_EQ(DistanceBlock(nodes).bytes(), sizeof(DistanceBlock) + 16 * (bits / 32 + 2));
  }
  EXPECT_EQ(met.size(), kWidths.size() * kWidths.size());
}

TEST(DistanceBlock, KeepsTheSignOfZeroAndTheSmallestNumbers) {
  DistanceNodes nodes;
  for (std::size_t n = 0; n < kBlockNodes; ++n) {
    const float values[] = {0.0F, -0.0F, 1e-45F, -1e-45F, 1e-38F, 8.0F, -8.0F, -1e-30F};
    nodes.phi[n] = values[n * 2654435769U >> 16 & 7U];
  }
  expectKept(nodes);
  for (const float value : {0.0F, -0.0F, kBackground, -kBackground}) {
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

// The rows predict a plane of any orientation up to their rounding.
TEST(DistanceBlock, StoresAPlaneInAFewBitsPerNode) {
  for (const Vec3& n :
       {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 2, 3), Vec3(-3, 1, 2)}) {
    const Vec3 u = n.normalized();
    const DistanceBlock block(
        sampled([&](double x, double y, double z) { return u.dot(Vec3(x, y, z)) + 0.3; }));
    EXPECT_LE(block.bytes(), 600U) << n.transpose(); // 2048 unpacked
  }
}

// Noise is unpredictable: the packed size may then slightly exceed that of the nodes.
TEST(DistanceBlock, IsAtMostAnEleventhLargerThanItsNodes) {
  std::mt19937 random(3);
  std::size_t most = 0;
  for (int round = 0; round < 100; ++round) {
    DistanceNodes nodes;
    for (float& phi : nodes.phi) do
        phi = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
      while (!(std::abs(phi) < kBackground));
    most = std::max(most, DistanceBlock(nodes).bytes());
  }
  EXPECT_EQ(most, 2224U); // 144 and 128 groups of four with 16 bytes, and two more that are read
  EXPECT_LE(11 * most, 12 * sizeof(DistanceNodes));
}

// The more frequent of the two ends is filled in, at any position in a row.
TEST(DistanceBlock, SizeDoesNotDependOnTheNodesBeyondTheBand) {
  for (const float beyond : {kBackground, -kBackground})
    for (std::size_t lane = 0; lane < 4; ++lane) {
      std::mt19937 random(9);
      DistanceNodes nodes;
      nodes.phi.fill(1);
      for (std::size_t n = lane; n < kBlockNodes; n += 4)
        if (random() % 2) nodes.phi[n] = beyond;
      nodes.phi[lane ^ 1] = -beyond;
      EXPECT_LE(DistanceBlock(nodes).bytes(), 300U) << beyond << ' ' << lane;
      expectKept(nodes);
    }
}

} // namespace
} // namespace patina
