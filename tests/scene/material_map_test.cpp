#include "scene/paint/material_map.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

namespace patina {
namespace {

const Vec3 kOrigin(-0.01, 0.02, -0.03);
constexpr double kVoxel = 7e-4;

std::size_t nodeOf(int x, int y, int z) {
  return static_cast<std::size_t>(64 * z + 8 * y + x);
}

// Paints all nodes of the blocks from `low` to `high` for any base.
void fill(MaterialMap& map, MaterialChannel channel, int low, int high,
          const std::function<double(const Vec3&)>& value) {
  for (int bz = low; bz < high; ++bz)
    for (int by = low; by < high; ++by)
      for (int bx = low; bx < high; ++bx) {
        MaterialLayer& layer = map.writable({bx, by, bz}, channel);
        for (int z = 0; z < 8; ++z)
          for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
              const Vec3 p = map.origin() + map.voxel() * Vec3(8 * bx + x, 8 * by + y, 8 * bz + z);
              layer.value[nodeOf(x, y, z)] = static_cast<float>(value(p));
              layer.weight[nodeOf(x, y, z)] = 1;
            }
      }
}

TEST(MaterialMap, UnpaintedMapIsTheBaseBitForBit) {
  const MaterialMap map(kOrigin, kVoxel);
  const Material base{612.7, 0.3, 0.2, 1.5, 1e-5};
  EXPECT_EQ(map.at({0, 0, 0}, base), base);
  EXPECT_EQ(map.at(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), base), base);
  EXPECT_EQ(map.at(Vec3::Constant(1e30), base), base);
  EXPECT_FALSE(map.has(MaterialChannel::stiffness));
}

// T-K22a, to the rounding of the floats that store it.
TEST(MaterialMap, AffineFieldIsReproducedAcrossBlocks) {
  MaterialMap map(kOrigin, kVoxel);
  const auto affine = [](const Vec3& p) { return 900 + 4000 * p.x() - 9000 * p.y() + 700 * p.z(); };
  fill(map, MaterialChannel::stiffness, -1, 2, affine);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> node(-7.9, 14.9);
  for (int n = 0; n < 500; ++n) {
    const Vec3 p = kOrigin + kVoxel * Vec3(node(random), node(random), node(random));
    const Material felt = map.at(p, {});
    EXPECT_NEAR(felt.stiffness, affine(p), 1e-4);
    EXPECT_EQ(felt.static_friction, 0); // the other channels stay the base's
  }
}

// K18: the present base shows through, not the base at the time of painting.
TEST(MaterialMap, PaintFollowsAChangedBase) {
  MaterialMap map(kOrigin, kVoxel);
  MaterialLayer& layer = map.writable({0, 0, 0}, MaterialChannel::damping);
  layer.value.fill(0.25f * 8); // weight 0.25 of 8 N s/m
  layer.weight.fill(0.25f);
  const Vec3 p = kOrigin + kVoxel * Vec3(3.2, 3.7, 2.1);
  Material base;
  base.damping = 4;
  EXPECT_NEAR(map.at(p, base).damping, 0.25 * 8 + 0.75 * 4, 1e-6);
  base.damping = 0;
  EXPECT_NEAR(map.at(p, base).damping, 2, 1e-6);
}

// T-K22c: linear over one cell, continuous.
TEST(MaterialMap, HalfPaintedPlaneIsLinearOverOneCell) {
  MaterialMap map(Vec3::Zero(), 1e-3);
  fill(map, MaterialChannel::stiffness, -1, 0, [](const Vec3&) { return 1000.0; });
  Material base;
  base.stiffness = 200;
  for (double x = -3; x <= 3; x += 0.125) {
    const double painted = std::clamp(-x, 0.0, 1.0); // the last painted node lies at -1
    EXPECT_NEAR(map.at({x * 1e-3, -2.5e-3, -2.5e-3}, base).stiffness, 200 + 800 * painted, 1e-9)
        << x;
  }
}

TEST(MaterialMap, CopiesShareLayersUntilOneIsWritten) {
  MaterialMap map(kOrigin, kVoxel);
  map.writable({0, 0, 0}, MaterialChannel::stiffness).value[3] = 5;
  map.writable({4, -2, 0}, MaterialChannel::roughness).value[0] = 1e-5f;
  MaterialMap copy = map;
  EXPECT_EQ(copy.layer({0, 0, 0}, MaterialChannel::stiffness),
            map.layer({0, 0, 0}, MaterialChannel::stiffness));
  copy.writable({0, 0, 0}, MaterialChannel::stiffness).value[3] = 6;
  EXPECT_EQ(map.layer({0, 0, 0}, MaterialChannel::stiffness)->value[3], 5);
  EXPECT_EQ(copy.layer({4, -2, 0}, MaterialChannel::roughness),
            map.layer({4, -2, 0}, MaterialChannel::roughness));
}

TEST(MaterialMap, SameIsBitwiseAndTreatsAbsentAsZero) {
  MaterialMap a(kOrigin, kVoxel), b(kOrigin, kVoxel);
  b.writable({1, 2, 3}, MaterialChannel::damping);
  EXPECT_TRUE(same(a, b));
  EXPECT_TRUE(same(b, a));
  b.writable({1, 2, 3}, MaterialChannel::damping).weight[7] = 1e-30f;
  EXPECT_FALSE(same(a, b));
  EXPECT_FALSE(same(b, a));
  EXPECT_FALSE(same(MaterialMap(kOrigin, kVoxel), MaterialMap(kOrigin, 2 * kVoxel)));
  b.writable({1, 2, 3}, MaterialChannel::damping).weight[7] = 0;
  b.dropEmptyLayers();
  EXPECT_TRUE(b.blocks().empty());
}

TEST(MaterialMap, InvalidGridsAreRejected) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(MaterialMap(kOrigin, 0), std::invalid_argument);
  EXPECT_THROW(MaterialMap(kOrigin, nan), std::invalid_argument);
  EXPECT_THROW(MaterialMap(Vec3(0, nan, 0), kVoxel), std::invalid_argument);
}

TEST(MaterialMap, BytesGrowByTheLayersThatArePainted) {
  MaterialMap map(kOrigin, kVoxel);
  const std::size_t none = map.bytes();
  map.writable({0, 0, 0}, MaterialChannel::stiffness);
  const std::size_t one = map.bytes();
  map.writable({0, 0, 0}, MaterialChannel::damping);
  EXPECT_GE(one - none, sizeof(MaterialLayer));
  EXPECT_EQ(map.bytes() - one, sizeof(MaterialLayer));
}

TEST(MaterialChannels, NamesUnitsAndValuesMatch) {
  Material material;
  double value = 1;
  for (const MaterialChannel channel : kAllMaterialChannels) valueOf(material, channel) = value++;
  EXPECT_EQ(material, (Material{1, 2, 3, 4, 5}));
  EXPECT_EQ(name(MaterialChannel::static_friction), "friction.static");
  EXPECT_EQ(unit(MaterialChannel::damping), "N s/m");
  EXPECT_EQ(unit(MaterialChannel::dynamic_friction), "");
}

TEST(MaterialMap, PublishedLayerIsCopiedEvenIfReleased) {
  MaterialMap map(Vec3::Zero(), 1e-3);
  const MaterialMap::Index at{0, 0, 0};
  map.writable(at, MaterialChannel::stiffness).value[0] = 1;
  const MaterialLayer* const own = map.layer(at, MaterialChannel::stiffness);
  map.writable(at, MaterialChannel::stiffness).value[1] = 1;
  EXPECT_EQ(map.layer(at, MaterialChannel::stiffness), own);
  std::weak_ptr<MaterialLayer> layer =
      map.blocks().at(at).layer[static_cast<std::size_t>(MaterialChannel::stiffness)];
  { const MaterialMap seen = map.published(); }
  map.writable(at, MaterialChannel::stiffness).value[2] = 1;
  EXPECT_TRUE(layer.expired());
}

} // namespace
} // namespace patina
