#include "scene/paint/material_reader.h"

#include <chrono>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "support/painted_shapes.h"

namespace patina {

namespace material_plain { // material_reader.cpp
void lookUp(const MaterialView& view, const double* p, double* material,
            double* const* gradients) noexcept;
}

namespace {

constexpr double kSampleVoxel = 0x1p-10;

struct HapticAt {
  Material material;
  MaterialGradients gradients;
};
HapticAt compositedAt(const MaterialSamples& samples, const Vec3& p) {
  HapticAt at{samples.base, {}};
  MaterialReader(samples, Pose::Identity()).read(p, at.material, at.gradients);
  return at;
}

// T-K22a: an affine field, exact in floats at the nodes, is reproduced between them.
TEST(MaterialSamples, ReproduceAnAffineFieldToRounding) {
  const auto affine = [](const Vec3& p) {
    return 1024 + 0x1p12 * p.x() - 0x1p13 * p.y() + 0x1p11 * p.z();
  };
  const auto map = coveredMap(kSampleVoxel, cube(12e-3), MaterialChannel::stiffness, affine);
  const auto samples = materialSamples(*map, Material{}, nullptr, nullptr);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> in(-11e-3, 11e-3);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p(in(random), in(random), in(random));
    const HapticAt at = compositedAt(*samples, p);
    ASSERT_NEAR(at.material.stiffness, affine(p), 1e-14 * 1024);
    ASSERT_NEAR(at.material.stiffness, map->at(p, Material{}).stiffness, 1e-14 * 1024);
    ASSERT_LT((at.gradients.stiffness - Vec3(0x1p12, -0x1p13, 0x1p11)).norm(), 1e-9);
  }
}

// The samples agree with MaterialMap::at() in blocks, at their borders and at nodes, for two
// channels.
TEST(MaterialSamples, AgreeWithTheMapEverywhere) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> value(0, 900), weight(0, 1);
  auto map = std::make_shared<MaterialMap>(Vec3(1e-3, -2e-3, 0.3e-3), kSampleVoxel);
  for (const MaterialMap::Index& b :
       {MaterialMap::Index{0, 0, 0}, {1, 0, 0}, {-1, 0, 2}, {4, -3, 1}})
    for (const auto channel : {MaterialChannel::stiffness, MaterialChannel::dynamic_friction}) {
      MaterialLayer& layer = map->writable(b, channel);
      for (std::size_t n = 0; n < kMaterialNodes; ++n) {
        layer.value[n] = static_cast<float>(value(random));
        layer.weight[n] = static_cast<float>(weight(random));
      }
    }
  Material base;
  base.stiffness = 333.3;
  base.damping = 1.7;
  const auto samples = materialSamples(*map, base, nullptr, nullptr);
  std::uniform_real_distribution<double> in(-0.04, 0.05);
  int painted = 0;
  for (int i = 0; i < 40000; ++i) {
    const Vec3 p(in(random), in(random), in(random));
    const Material wanted = map->at(p, base), found = compositedAt(*samples, p).material;
    ASSERT_NEAR(found.stiffness, wanted.stiffness, 1e-10);
    ASSERT_NEAR(found.dynamic_friction, wanted.dynamic_friction, 1e-10);
    ASSERT_EQ(found.damping, base.damping);
    painted += wanted.stiffness != base.stiffness;
    if (wanted.stiffness == base.stiffness) {
      ASSERT_EQ(found.stiffness, base.stiffness);
    }
  }
  EXPECT_GT(painted, 100);
  const double far = 1e300, nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(compositedAt(*samples, Vec3(far, -far, 0)).material, base);
  EXPECT_EQ(compositedAt(*samples, Vec3(nan, 0, 0)).material, base);
}

// For a rotated and moved object, value and gradient are those of the map at the point in the
// object's own frame.
TEST(MaterialReader, ReadsObjectValuesAtWorldPoints) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> value(0, 900);
  MaterialMap map(Vec3(1e-3, -2e-3, 0.3e-3), kSampleVoxel);
  for (const MaterialMap::Index& b :
       {MaterialMap::Index{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}})
    for (const auto channel :
         {MaterialChannel::stiffness, MaterialChannel::damping, MaterialChannel::roughness})
      for (float& each : map.writable(b, channel).value)
        each = static_cast<float>((channel == MaterialChannel::roughness ? 1e-7 : 1e-3) *
                                  value(random));
  const Material base;
  const auto samples = materialSamples(map, base, nullptr, nullptr);
  Pose world_from_object = Pose::Identity();
  world_from_object.translate(Vec3(0.2, -0.1, 0.05))
      .rotate(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()));
  const Pose object_from_world = world_from_object.inverse();
  const MaterialReader reader(*samples, object_from_world);
  const auto at = [&](const Vec3& p) {
    HapticAt felt{base, {}};
    reader.read(p, felt.material, felt.gradients);
    return felt;
  };
  std::uniform_real_distribution<double> in(0, 15), part(0.1, 0.9);
  constexpr double kStep = 1e-7;
  for (int i = 0; i < 2000; ++i) {
    // Points lie within a cell, so that differences are those of one trilinear function.
    const Vec3 cell(std::floor(in(random)), std::floor(in(random)), std::floor(in(random)));
    const Vec3 own =
        map.origin() + kSampleVoxel * (cell + Vec3(part(random), part(random), part(random)));
    const Vec3 p = world_from_object * own;
    const HapticAt felt = at(p);
    const Material told = map.at(own, base);
    ASSERT_NEAR(felt.material.stiffness, told.stiffness, 1e-9);
    ASSERT_NEAR(felt.material.damping, told.damping, 1e-9);
    ASSERT_NEAR(felt.material.roughness, told.roughness, 1e-15);
    ASSERT_EQ(felt.material.static_friction, base.static_friction);
    for (int a = 0; a < 3; ++a) {
      const Vec3 d = kStep * Vec3::Unit(a);
      const HapticAt above = at(p + d), below = at(p - d);
      ASSERT_NEAR(felt.gradients.stiffness[a],
                  (above.material.stiffness - below.material.stiffness) / (2 * kStep), 1e-3);
      ASSERT_NEAR(felt.gradients.roughness[a],
                  (above.material.roughness - below.material.roughness) / (2 * kStep), 1e-7);
    }
  }
}

TEST(MaterialReader, ReadsTheSameOnEveryProcessor) {
  const auto map =
      coveredMap(kSampleVoxel, cube(12e-3), MaterialChannel::stiffness,
                 [](const Vec3& p) { return 500 + 1e6 * p.x() * p.y() - 2e3 * p.z(); });
  coveredMap(
      kSampleVoxel, cube(9e-3), MaterialChannel::damping,
      [](const Vec3& p) { return 2 + 90 * p.y(); }, map);
  const auto samples = materialSamples(*map, Material{}, nullptr, nullptr);
  const MaterialReader reader(*samples, Pose::Identity());
  std::mt19937 random(8);
  std::uniform_real_distribution<double> in(-16e-3, 16e-3);
  int painted = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(in(random), in(random), in(random));
    HapticAt felt{samples->base, {}};
    reader.read(p, felt.material, felt.gradients);
    HapticAt plain{samples->base, {}};
    double* const into[] = {plain.gradients.stiffness.data(), plain.gradients.roughness.data()};
    material_plain::lookUp(reader.view(), p.data(), &plain.material.stiffness, into);
    painted += !(felt.material == samples->base);
    ASSERT_NEAR(plain.material.stiffness, felt.material.stiffness, 1e-10);
    ASSERT_NEAR(plain.material.damping, felt.material.damping, 1e-12);
    ASSERT_LT((plain.gradients.stiffness - felt.gradients.stiffness).norm(), 1e-7);
    ASSERT_TRUE(plain.gradients.roughness.isZero(0));
  }
  EXPECT_GT(painted, 500);
}

TEST(MaterialSamples, HoldTheExtremesOfEveryChannelAndTheBase) {
  auto map = coveredMap(kSampleVoxel, cube(3e-3), MaterialChannel::stiffness,
                        [](const Vec3& p) { return p.x() > 0 ? 2000 : 100; });
  coveredMap(
      kSampleVoxel, cube(1e-3), MaterialChannel::damping, [](const Vec3&) { return 3; }, map);
  const auto samples = materialSamples(*map, Material{}, nullptr, nullptr);
  EXPECT_EQ(samples->max.stiffness, 2000);
  EXPECT_EQ(samples->min.stiffness, 100);
  EXPECT_EQ(samples->max.damping, 3);
  EXPECT_EQ(samples->min.damping, 0);
  EXPECT_EQ(samples->max.roughness, 0);
  EXPECT_FALSE(samples->painted[4]);
}

// Values added to a base that was reduced later are clamped to the channel's range: a negative
// stiffness or damping would drive the hand.
TEST(MaterialSamples, AddedValuesStayWithinTheRange) {
  auto map = std::make_shared<MaterialMap>(Vec3::Zero(), kSampleVoxel);
  const std::pair<MaterialChannel, float> kAdded[] = {{MaterialChannel::stiffness, -900.0F},
                                                      {MaterialChannel::static_friction, 9.9F},
                                                      {MaterialChannel::damping, -2.0F}};
  for (const auto& [channel, added] : kAdded)
    for (std::size_t n = 0; n < kMaterialNodes; n += 3)
      map->writable({0, 0, 0}, channel).value[n] = added;
  Material base; // they were 1000 N/m, 0.1 and 3 N s/m
  base.stiffness = 500;
  base.static_friction = 0.5;
  base.damping = 1;
  const auto samples = materialSamples(*map, base, nullptr, nullptr);
  EXPECT_EQ(samples->min.stiffness, 0);
  EXPECT_EQ(samples->max.static_friction, rangeOf(MaterialChannel::static_friction).max);
  EXPECT_EQ(samples->min.damping, 0);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> in(-1 * kSampleVoxel, 8 * kSampleVoxel);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(in(random), in(random), in(random));
    const Material felt = compositedAt(*samples, p).material, told = map->at(p, base);
    for (const MaterialChannel channel : kAllMaterialChannels) {
      ASSERT_GE(valueOf(felt, channel), 0) << name(channel);
      ASSERT_LE(valueOf(felt, channel), rangeOf(channel).max) << name(channel);
      ASSERT_NEAR(valueOf(felt, channel), valueOf(told, channel), 1e-10) << name(channel);
    }
  }
}

TEST(MaterialSamples, AreEmptyForAnEmptyMap) {
  EXPECT_EQ(materialSamples(MaterialMap(Vec3::Zero(), kSampleVoxel), Material{}, nullptr, nullptr),
            nullptr);
}

// An edit computes its own blocks and those that read them, and no other; the result equals a fresh
// build, also where paint is removed.
TEST(MaterialSamples, ShareBlocksThatAnEditKeeps) {
  const Material base;
  auto before = coveredMap(kSampleVoxel, cube(30e-3), MaterialChannel::stiffness,
                           [](const Vec3& p) { return 800 + 1e4 * p.x(); });
  const auto old = materialSamples(*before, base, nullptr, nullptr);
  const auto check = [&](const MaterialMap& map, std::size_t max_made) {
    const auto start = std::chrono::steady_clock::now();
    const auto now = materialSamples(map, base, before.get(), old.get());
    const std::chrono::duration<double, std::micro> us = std::chrono::steady_clock::now() - start;
    const auto fresh = materialSamples(map, base, nullptr, nullptr);
    std::size_t made = 0;
    for (const auto& block : now->block)
      made += std::find(old->block.begin(), old->block.end(), block) == old->block.end();
    std::printf("%zu of %zu blocks made anew in %.0f us\n", made, now->block.size(), us.count());
    EXPECT_LE(made, max_made);
    EXPECT_GE(made, 1u);
    ASSERT_EQ(now->block_at, fresh->block_at);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> in(-0.035, 0.035);
    for (int i = 0; i < 20000; ++i) {
      const Vec3 p(in(random), in(random), in(random));
      ASSERT_EQ(compositedAt(*now, p).material, compositedAt(*fresh, p).material);
    }
  };
  MaterialMap edited = *before;
  edited.writable({1, -1, 2}, MaterialChannel::stiffness).value[77] = 12345;
  check(edited, 8);
  MaterialMap grown = *before; // outside the old table
  grown.writable({6, 0, 0}, MaterialChannel::stiffness).value[0] = 5;
  check(grown, 8);
  MaterialMap less(before->origin(), before->voxel());
  for (const auto& [index, block] : before->blocks())
    if (index != MaterialMap::Index{0, 0, 0} && index != MaterialMap::Index{3, 3, 3})
      less.writable(index, MaterialChannel::stiffness) =
          *before->layer(index, MaterialChannel::stiffness);
  // Copies of layers are separate layers; use those of `before` itself.
  MaterialMap shrunk = *before;
  shrunk.writable({0, 0, 0}, MaterialChannel::stiffness) = MaterialLayer{};
  shrunk.writable({3, 3, 3}, MaterialChannel::stiffness) = MaterialLayer{};
  shrunk.dropEmptyLayers();
  check(shrunk, 16);
}

} // namespace
} // namespace patina
