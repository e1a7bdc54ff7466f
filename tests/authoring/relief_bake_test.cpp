#include "authoring/relief/relief_bake.h"

#include <algorithm>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "authoring/relief_shapes.h"
#include "core/error.h"
#include "field/sampling/field_sampler.h"
#include "geometry/atlas/texel_map.h"

namespace patina {
namespace {

using namespace test;

constexpr double kRadius = 0.05;

bool same(const DistanceBlock& a, const DistanceBlock& b) {
  const auto phi = a.phi(), other = b.phi();
  return std::memcmp(&phi, &other, sizeof(phi)) == 0;
}

bool same(const SampleBlock& a, const SampleBlock& b) {
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}

template <class Block>
bool sameBlocks(const std::vector<std::shared_ptr<const Block>>& a,
                const std::vector<std::shared_ptr<const Block>>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& of_a, const auto& of_b) {
    return of_a == of_b || same(*of_a, *of_b);
  });
}

bool sameBits(const SurfaceField& a, const SurfaceField& b) {
  return a.band == b.band && a.block_index == b.block_index && a.face == b.face &&
         sameBlocks(a.distance, b.distance) && sameBlocks(a.sample, b.sample) &&
         a.coarse.size() == b.coarse.size() &&
         std::memcmp(a.coarse.data(), b.coarse.data(), a.coarse.size() * sizeof(CoarseNode)) == 0;
}

std::size_t sharedBlocks(const SurfaceField& a, const SurfaceField& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.blockCount(); ++i) {
    EXPECT_TRUE(a.distance[i] == b.distance[i] || a.sample[i] != b.sample[i]);
    count += a.distance[i] == b.distance[i];
  }
  return count;
}

double constant(double, double) {
  return 1;
}

// A sphere with the generated layout of a mesh without coordinates.
struct Sphere {
  TriangleMesh mesh;
  std::shared_ptr<const CornerUvs> uvs;
  std::shared_ptr<const SurfaceField> field;

  explicit Sphere(int frequency = 20, int resolution = 60, double band = 8)
      : mesh(icosphere(kRadius, frequency)), uvs(textureLayout(mesh, 128).uvs) {
    FieldSpec spec;
    spec.resolution = resolution;
    spec.band = band;
    field = fieldOf(mesh, spec);
  }
  std::vector<ReliefInput> with(std::shared_ptr<const TiledImage> image,
                                double height = 1e-3) const {
    return {sourceOf(mesh, uvs, std::move(image), height)};
  }
};

// A block whose top, z = kTableTop, shows the image as seen from above.
constexpr double kTableTop = 0.02, kTableWidth = 0.08;

struct Slab {
  TriangleMesh mesh = box(Vec3(kTableWidth, kTableWidth, 2 * kTableTop), 4);
  std::shared_ptr<const CornerUvs> uvs = uvsBy(mesh, [](const Vec3& p) {
    return Vec2(p.x() / kTableWidth + 0.5, p.y() / kTableWidth + 0.5);
  });
  std::shared_ptr<const SurfaceField> field;

  explicit Slab(double voxel, double band = 8) {
    FieldSpec spec;
    spec.voxel = voxel;
    spec.band = band;
    field = fieldOf(mesh, spec);
  }
  std::shared_ptr<const SurfaceField> baked(std::shared_ptr<const TiledImage> image,
                                            double height) const {
    const std::vector<ReliefInput> sources{sourceOf(mesh, uvs, std::move(image), height)};
    return bakeOf(field, mesh, sources).baked(sources);
  }
  double heightAt(const SurfaceField& of, double x, double y) const {
    const double from = kTableTop + 6 * of.grid.voxel;
    return from - surfaceAt(of, Vec3(x, y, from), -Vec3::UnitZ()) - kTableTop;
  }
};

// T-K21a. The bound is h^2 / (4 R) of the samples plus the depth of the facets below the sphere.
TEST(ReliefBake, ConstantReliefGrowsASphereByTheHeight) {
  const Sphere sphere(80, 80);
  const double h = sphere.field->grid.voxel;
  double sagitta = 0;
  for (std::size_t f = 0; f < sphere.mesh.triangles.size(); ++f)
    sagitta = std::max(
        sagitta,
        kRadius -
            position(sphere.mesh, {static_cast<std::int32_t>(f), Vec3::Constant(1.0 / 3)}).norm());
  for (const double height : {1e-3, -1e-3, 3e-3}) {
    const auto sources = sphere.with(reliefImage(128, constant), height);
    const auto field = bakeOf(sphere.field, sphere.mesh, sources).baked(sources);
    std::mt19937 random(1);
    for (int i = 0; i < 300; ++i) {
      std::normal_distribution<double> normal;
      const Vec3 n = Vec3(normal(random), normal(random), normal(random)).normalized();
      const double r = 1.15 * kRadius - surfaceAt(*field, 1.15 * kRadius * n, -n);
      EXPECT_NEAR(r, kRadius + height, h * h / (4 * kRadius) + sagitta + 1e-8);
    }
  }
}

// White in any layout is one height: no node may read the black between the charts (K16).
TEST(ReliefBake, SeamsAreInvisibleUnderFullPaint) {
  const Sphere sphere;
  const int size = 128;
  const TexelMap texels = texelMap(*sphere.uvs, size, size);
  const auto image = reliefImage(size, [&](double u, double v) {
    return texels.ownerAt(static_cast<int>(u * size), static_cast<int>(v * size)) >= 0 ? 1.0 : 0.0;
  });
  const auto sources = sphere.with(image);
  const auto field = bakeOf(sphere.field, sphere.mesh, sources).baked(sources);
  const auto height = static_cast<float>(1e-3 / sphere.field->grid.voxel);
  std::size_t nodes = 0, low = 0;
  for (std::size_t slot = 0; slot < field->blockCount(); ++slot) {
    const auto old_phi = sphere.field->distance[slot]->phi(), phi = field->distance[slot]->phi();
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      const float before = old_phi[n], after = phi[n];
      if (!(std::abs(before) < kBackground)) {
        EXPECT_EQ(before, after);
        continue;
      }
      ++nodes;
      low += after != before - height;
    }
  }
  EXPECT_GT(nodes, 20000U);
  EXPECT_EQ(low, 0U);
}

// T-K21b, F8: between nodes a crest is cut off.
TEST(ReliefBake, CosineLosesTheAttenuationOfTheGrid) {
  const double voxel = 1e-3, amplitude = 0.2e-3;
  const Slab slab(voxel);
  const FieldGrid& grid = slab.field->grid;
  const double crest = grid.toWorld(Vec3::Constant(grid.nodes[0] / 2 + 0.5)).x();
  for (const double voxels : {4.0, 8.0, 16.0}) {
    const double wavelength = voxels * voxel;
    const auto field = slab.baked(reliefImage(1024,
                                              [&](double u, double) {
                                                const double x = (u - 0.5) * kTableWidth - crest;
                                                return std::cos(2 * M_PI * x / wavelength);
                                              }),
                                  amplitude);
    const double expected = 1 - std::cos(M_PI * voxel / wavelength);
    const double texel = kTableWidth / 1024, bilinear = 1 - std::cos(M_PI * texel / wavelength);
    EXPECT_NEAR(1 - slab.heightAt(*field, crest, 0) / amplitude, expected, 2 * bilinear + 1e-3);
    EXPECT_NEAR(1 - slab.heightAt(*field, crest + 0.5 * voxel, 0) / amplitude,
                1 - std::cos(M_PI / voxels), 2 * bilinear + 1e-3);
  }
}

// T-K21e
TEST(ReliefBake, ImageIsUprightAndNotMirrored) {
  const Slab slab(2e-3);
  const auto field =
      slab.baked(reliefImage(64,
                             [](double u, double v) {
                               return u < 0.5 ? (v < 0.5 ? 0.2 : 0.4) : (v < 0.5 ? 0.6 : 1.0);
                             }),
                 3e-3);
  const double at = 0.3 * kTableWidth;
  EXPECT_NEAR(slab.heightAt(*field, -at, -at), 0.2 * 3e-3, 1e-8);
  EXPECT_NEAR(slab.heightAt(*field, -at, at), 0.4 * 3e-3, 1e-8);
  EXPECT_NEAR(slab.heightAt(*field, at, -at), 0.6 * 3e-3, 1e-8);
  EXPECT_NEAR(slab.heightAt(*field, at, at), 1.0 * 3e-3, 1e-8);
}

// T-K21f, the field's part: the direction is that of the relief's flank.
TEST(ReliefBake, DirectionTiltsByTheSlopeOfARamp) {
  const double voxel = 1e-3, half = 6e-3; // the ramp runs from -half to half
  for (const double angle : {10.0, 30.0}) {
    const double a = std::tan(angle * M_PI / 180);
    const Slab slab(voxel, 12);
    const auto field = slab.baked(
        reliefImage(512,
                    [&](double u, double) {
                      return std::clamp(((u - 0.5) * kTableWidth / half + 1) / 2, 0.0, 1.0);
                    }),
        2 * half * a);
    const FieldSampler sampler(*field, Sampler::kim);
    for (const double x : {-2e-3, 0.0, 1.3e-3}) {
      const double z = slab.heightAt(*field, x, 2e-3);
      EXPECT_NEAR(z, a * (x + half), 1e-8);
      const Vec3 g = sampler.at(Vec3(x, 2e-3, kTableTop + z - 1e-4)).gradient.normalized();
      EXPECT_NEAR(std::atan2(-g.x(), g.z()), std::atan(a), 1e-5);
      EXPECT_NEAR(g.y(), 0, 1e-5);
    }
  }
}

// T-K21c, T-K21d
TEST(ReliefBake, StartsFromTheBaseEachTime) {
  const Sphere sphere;
  const auto waves = reliefImage(128, [](double u, double v) { return std::sin(30 * u + 20 * v); });
  const auto sources = sphere.with(waves);
  const ReliefBake bake = bakeOf(sphere.field, sphere.mesh, sources);
  const auto base = withSamples(sphere.field);
  const auto once = bake.baked(sources), twice = bake.baked(sources);
  EXPECT_TRUE(sameBits(*once, *twice));
  EXPECT_FALSE(sameBits(*once, *base));
  EXPECT_TRUE(sameBits(*bake.updateBaked(*once, sources, sources), *once));

  auto black = std::make_shared<TiledImage>(128, 128, 1);
  for (std::size_t i = 0; i < black->tileCount(); ++i) black->writable(i);
  for (const auto& flat : {sphere.with(nullptr), sphere.with(black), sphere.with(waves, 0),
                           sphere.with(std::make_shared<TiledImage>(64, 64, 1))}) {
    EXPECT_TRUE(sameBits(*bake.baked(flat), *base));
    EXPECT_EQ(sharedBlocks(*bake.baked(flat), *base), base->blockCount());
    EXPECT_TRUE(sameBits(*bake.updateBaked(*once, sources, flat), *base));
    EXPECT_TRUE(sameBits(*bake.updateBaked(*base, flat, sources), *once));
  }
}

// Samples of a version equal those computed for the whole field.
TEST(ReliefBake, SamplesAreThoseOfTheMovedNodes) {
  const Sphere sphere;
  const auto sources = sphere.with(reliefImage(
      128, [](double u, double v) { return std::max(0.0, 1 - 8 * std::hypot(u - 0.5, v - 0.5)); }));
  const auto field = bakeOf(sphere.field, sphere.mesh, sources).baked(sources);
  SurfaceField bare = *field;
  bare.sample.clear();
  const auto again = withSamples(std::make_shared<const SurfaceField>(std::move(bare)));
  EXPECT_TRUE(sameBlocks(field->sample, again->sample));
  const auto base = withSamples(sphere.field);
  const std::size_t kept = sharedBlocks(*field, *base);
  EXPECT_GT(kept, 0U);
  EXPECT_LT(kept, base->blockCount());
}

TEST(ReliefBake, DabsAreBitwiseEqualToTheWholeImage) {
  const Sphere sphere(8, 50);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  auto sources = sphere.with(std::make_shared<TiledImage>(128, 128, 1), 2e-3);
  const ReliefBake bake = bakeOf(sphere.field, sphere.mesh, sources);
  auto field = bake.baked(sources);
  for (int dab = 0; dab < 60; ++dab) {
    auto image = std::make_shared<TiledImage>(*sources[0].image);
    const double x = 128 * unit(random), y = 128 * unit(random), r = 1 + 9 * unit(random);
    const auto value = static_cast<float>(dab % 5 == 4 ? 0.0 : 2 * unit(random) - 1);
    for (int j = 0; j < 128; ++j)
      for (int i = 0; i < 128; ++i)
        if (std::hypot(i + 0.5 - x, j + 0.5 - y) < r)
          image->writable(image->tileOf(i, j))[image->offsetOf(i, j)] = value;
    const auto old_sources = sources;
    sources[0].image = image;
    const auto old_field = field;
    field = bake.updateBaked(*old_field, old_sources, sources);
    ASSERT_TRUE(sameBits(*field, *bake.baked(sources))) << dab;
    const std::size_t shared = sharedBlocks(*field, *old_field);
    EXPECT_TRUE(dab == 0 || shared > field->blockCount() / 2);
  }
}

TEST(ReliefBake, HoldsExtremesOfAnImage) {
  const Sphere sphere(20, 60, 14);
  const double height = 5e-3; // a step of 5 mm, too
  const float most = static_cast<float>(height / sphere.field->grid.voxel) * (1 + 1e-6F);
  const auto checkers = [](double u, double v) {
    return (static_cast<int>(u * 128) + static_cast<int>(v * 128)) % 2 ? 1.0 : 0.0;
  };
  const auto line = [](double u, double) { return static_cast<int>(u * 128) == 40 ? 1.0 : 0.0; };
  const auto step = [](double u, double) { return u < 0.4 ? 1.0 : -1.0; };
  for (const Height& g : {Height(constant), Height(checkers), Height(line), Height(step)}) {
    const auto sources = sphere.with(reliefImage(128, g), height);
    const auto field = bakeOf(sphere.field, sphere.mesh, sources).baked(sources);
    std::size_t moved = 0;
    for (std::size_t slot = 0; slot < field->blockCount(); ++slot) {
      const auto before = sphere.field->distance[slot]->phi(), phi = field->distance[slot]->phi();
      for (std::size_t n = 0; n < kBlockNodes; ++n) {
        const float by = before[n] - phi[n];
        moved += by != 0;
        ASSERT_LE(std::abs(by), most);
      }
      for (const SampleNode& node : field->sample[slot]->node)
        ASSERT_TRUE(std::isfinite(node.gx + node.gy + node.gz));
    }
    EXPECT_GT(moved, 0U);
  }
}

TEST(ReliefBake, RejectsHeightsBeyondTheBandAndNamesThem) {
  const Sphere sphere;
  const double voxel = sphere.field->grid.voxel;
  const auto image = reliefImage(128, constant);
  const ReliefBake bake = bakeOf(sphere.field, sphere.mesh, sphere.with(image));
  const double most = (8 - kBandMargin) * voxel;
  EXPECT_NEAR(bake.baked(sphere.with(image, 0.999 * most))->band, 3.005, 1e-9);
  for (const double height : {1.001 * most, -1.001 * most, 80 * voxel}) try {
      bake.baked(sphere.with(image, height));
      FAIL() << height;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("set band to "), std::string::npos) << error.what();
    }
  for (const double bad : {NAN, INFINITY}) {
    auto broken = std::make_shared<TiledImage>(*image);
    broken->writable(5)[70] = static_cast<float>(bad);
    EXPECT_THROW(bake.baked(sphere.with(broken)), Error);
  }
}

TEST(ReliefBake, RejectsOtherFieldsAndImages) {
  const Sphere sphere;
  const auto image = reliefImage(64, constant);
  const auto sources = sphere.with(image);
  const ReliefBake bake = bakeOf(sphere.field, sphere.mesh, sources);
  EXPECT_THROW(bake.baked({}), std::invalid_argument);
  auto other = sources;
  other[0].uvs = std::make_shared<const CornerUvs>(*sphere.uvs);
  EXPECT_THROW(bake.baked(other), std::invalid_argument);
  EXPECT_THROW(bake.baked(sphere.with(std::make_shared<TiledImage>(64, 64, 4))),
               std::invalid_argument);
  SurfaceField faceless = *sphere.field;
  faceless.face.clear();
  EXPECT_THROW(bakeOf(std::make_shared<const SurfaceField>(faceless), sphere.mesh, sources),
               std::invalid_argument);
  auto beyond = sources;
  beyond[0].first_face = 1;
  EXPECT_THROW(bakeOf(sphere.field, sphere.mesh, beyond), std::invalid_argument);
}

} // namespace
} // namespace patina
