// Baked relief in contact deeper than the band, and on several objects.
#include <random>

#include <gtest/gtest.h>

#include "authoring/relief_shapes.h"
#include "field/merged_shapes.h"
#include "field/sampling/field_sampler.h"

namespace patina {
namespace {

using namespace test;

constexpr double kBaked = 0.02;

Vec2 onSphere(const Vec3& p) { // continuous but at the poles of z and one meridian
  return {std::atan2(p.y(), p.x()) / (2 * M_PI) + 0.5, std::acos(p.z() / p.norm()) / M_PI};
}

std::shared_ptr<const TiledImage> white() {
  return reliefImage(64, [](double, double) { return 1.0; });
}

// Depth grows monotonically from outside to the centre, where the coarse nodes flatten it.
TEST(BakedRelief, DepthIsContinuousThroughTheEndOfTheBand) {
  const TriangleMesh mesh = icosphere(kBaked, 12);
  FieldSpec spec;
  spec.resolution = 100;
  const auto base = fieldOf(mesh, spec);
  const double h = base->grid.voxel;
  for (const double voxels : {4.0, -4.0, 0.0}) {
    const std::vector<ReliefInput> sources{
        sourceOf(mesh, uvsBy(mesh, onSphere), white(), voxels * h)};
    const auto field = bakeOf(base, mesh, sources).baked(sources);
    for (const Sampler kind : {Sampler::kim, Sampler::high}) {
      const FieldSampler sampler(*field, kind);
      const Vec3 n = Vec3(0.3, -0.5, 0.7).normalized();
      const double step = 0.02;
      double last = 0.6;
      for (double r = kBaked / h + 7; r > 10; r -= step) {
        const double phi = sampler.at(r * h * n).phi / h, exact = r - kBaked / h - voxels;
        if (exact < 0.5) {
          EXPECT_LE(phi, last + 1e-3) << r;
          EXPECT_GE(phi, last - 10 * step) << r;
          // Coarse nodes take over from -1.25 where 4 of the 8 voxels are relief.
          EXPECT_NEAR(phi, exact, exact > -1.2 ? 0.1 : 1.5) << r;
          last = phi;
        } else {
          EXPECT_LE(phi, exact + 0.1) << "no lower bound at " << r;
          EXPECT_GT(phi, 0);
        }
      }
    }
  }
}

// Outside the band, too, the value never exceeds the distance to the relief.
TEST(BakedRelief, OutsideTheBandTheFieldIsALowerBound) {
  const TriangleMesh mesh = icosphere(kBaked, 12);
  FieldSpec spec;
  spec.resolution = 100;
  const auto base = fieldOf(mesh, spec);
  const double h = base->grid.voxel, raised = 4;
  const std::vector<ReliefInput> sources{
      sourceOf(mesh, uvsBy(mesh, onSphere), white(), raised * h)};
  const auto field = bakeOf(base, mesh, sources).baked(sources);
  const FieldSampler sampler(*field, Sampler::kim);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 99);
  int beyond = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 q(unit(random), unit(random), unit(random));
    const double exact = (field->grid.toWorld(q).norm() - kBaked) / h - raised;
    const GridSample sample = sampler.atGrid(q);
    if (sample.region != FieldRegion::outside) continue;
    ASSERT_LE(sample.phi, exact + 0.1);
    beyond += sample.phi > field->band;
  }
  EXPECT_GT(beyond, 1000); // the bound exceeds the band
}

TEST(BakedRelief, MovesOnlyItsObject) {
  const std::vector<TriangleMesh> meshes{movedBy(icosphere(kBaked, 12), Vec3(-0.016, 0, 0)),
                                         movedBy(icosphere(kBaked, 12), Vec3(0.016, 0, 0))};
  for (const bool redistance : {false, true}) {
    const MergedShapes m = mergedShapes(meshes, 0x1p-10, redistance);
    const auto first = static_cast<std::int32_t>(meshes[0].triangles.size());
    const auto uvs =
        uvsBy(meshes[1], [](const Vec3& p) { return onSphere(p - Vec3(0.016, 0, 0)); });
    const auto halves = reliefImage(64, [](double, double v) { return v < 0.5 ? 1.0 : 0.25; });
    // The first object has a layout but no image; faces of the second are those of the combined
    // mesh.
    const std::vector<ReliefInput> sources{
        {0, first, uvsBy(meshes[0], onSphere), nullptr, 1e-3},
        {first, static_cast<std::int32_t>(uvs->size()), uvs, halves, 1e-3}};
    const ReliefBake bake = bakeOf(m.field, m.joint, sources);
    const auto field = bake.baked(sources);
    const auto fall = static_cast<float>(1e-3 / m.field->grid.voxel);
    std::size_t moved = 0, shared = 0;
    for (std::size_t slot = 0; slot < field->blockCount(); ++slot) {
      shared += field->sample[slot] == m.field->sample[slot];
      const auto old_phi = m.field->distance[slot]->phi(), phi = field->distance[slot]->phi();
      for (std::size_t n = 0; n < kBlockNodes; ++n) {
        const float before = old_phi[n], after = phi[n];
        const std::int32_t face = m.field->face[slot]->at(n);
        const bool moves = face >= first && std::abs(before) < kBackground;
        moved += moves;
        const double z = m.field->grid.origin.z() +
                         m.field->grid.voxel * (kBlockSide * m.field->block_at[slot][2] +
                                                static_cast<int>(n) / (kBlockSide * kBlockSide));
        if (moves && std::abs(z) < 4e-3) continue;
        ASSERT_EQ(after, moves ? before - fall * (z > 0 ? 1.0F : 0.25F) : before);
      }
    }
    EXPECT_GT(moved, 10000U);
    EXPECT_GT(shared, field->blockCount() / 4);

    auto flat = sources;
    flat[1].image = nullptr;
    EXPECT_EQ(bake.updateBaked(*field, sources, flat)->distance, m.field->distance);
    EXPECT_EQ(bake.updateBaked(*field, sources, flat)->sample, m.field->sample);
  }
}

// An object without a layout costs nothing and is unchanged.
TEST(BakedRelief, NeedsNoLayoutWithoutRelief) {
  const std::vector<TriangleMesh> meshes{movedBy(icosphere(kBaked, 6), Vec3(-0.03, 0, 0)),
                                         movedBy(icosphere(kBaked, 6), Vec3(0.03, 0, 0))};
  const MergedShapes m = mergedShapes(meshes, 0x1p-9);
  const auto faces = static_cast<std::int32_t>(meshes[0].triangles.size());
  std::vector<ReliefInput> sources{{0, faces, nullptr, nullptr, 1e-3},
                                   {faces, faces, nullptr, nullptr, 1e-3}};
  const std::size_t none = bakeOf(m.field, m.joint, sources).bytes();
  sources[1].uvs = uvsBy(meshes[1], [](const Vec3& p) { return onSphere(p - Vec3(0.03, 0, 0)); });
  const std::size_t one = bakeOf(m.field, m.joint, sources).bytes();
  sources[0].uvs = uvsBy(meshes[0], [](const Vec3& p) { return onSphere(p + Vec3(0.03, 0, 0)); });
  const std::size_t both = bakeOf(m.field, m.joint, sources).bytes();
  EXPECT_NEAR(static_cast<double>(both - one), static_cast<double>(one - none),
              0.1 * static_cast<double>(one - none));
  EXPECT_GT(one - none, 5 * none / 4);
}

} // namespace
} // namespace patina
