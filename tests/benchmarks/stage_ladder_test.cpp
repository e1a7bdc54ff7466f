// MATH section 3, (b), (c), (e): what a scene does not have costs neither bytes nor nanoseconds.
#include <cstdio>

#include <gtest/gtest.h>

#include "app/studies/query_timing.h"
#include "haptics/contact_fixture.h"

namespace patina {
namespace {

double nsOf(const HapticSnapshot& snapshot) {
  std::vector<Vec3> tips;
  for (int i = 0; i < 4000; ++i) {
    const double t = 1e-3 * i;
    const Vec3 n(std::sin(1 + 0.3 * t) * std::cos(t), std::sin(1 + 0.3 * t) * std::sin(t),
                 std::cos(1 + 0.3 * t));
    tips.push_back((0.03 - 1e-3 - 0.4e-3 * std::sin(9 * t)) * n);
  }
  ContactMemory memory;
  return nsPerQuery(
      tips, [&](const Vec3& tip) { return tick(snapshot, memory, tip, 1e-3).force.x(); }, 25);
}

TEST(StageLadder, EveryStageAddsAndThePrunedPipelineIsNotSlowerThanTheFullOne) {
  const Field sphere = sphereField();
  Scene scene = sceneOf(500);
  const auto rung = [&](const char* what) {
    const double ns = nsOf(*compileStages(scene, sphere));
    std::printf("%-28s %.1f ns a tick\n", what, ns);
    return ns;
  };
  const double contact = rung("contact, spring, limit");
  const double full = nsOf(*compileAllStages(scene, sphere));
  std::printf("%-28s %.1f ns a tick\n", "the same with neutral stages", full);
  EXPECT_LT(contact, 1.05 * full);
  scene.haptics.damping = 1;
  const double damped = rung("+ damping");
  scene = withFriction(scene, 0.5, 0.3);
  const double rough = rung("+ friction");
  scene.haptics.offset = 1e-3;
  rung("+ offset");
  EXPECT_LT(contact, 1.1 * damped);
  EXPECT_LT(damped, 1.05 * rough);
}

TEST(StageLadder, AbsentLayersAndStagesHoldNoBytes) {
  const Field sphere = sphereField();
  for (const LayerBytes& layer : sphere->layerBytes()) {
    EXPECT_GT(layer.bytes, 0u) << layer.name;
    EXPECT_NE(layer.name, "face"); // an analytic sphere has none
  }
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.5, 0.3), sphere);
  for (std::size_t i = 1; i < snapshot->why.size(); ++i)
    EXPECT_EQ(snapshot->why[i].bytes, 0u) << snapshot->why[i].name; // only contact reads layers
}

// (e): a sphere of 50 voxels' radius in a band of 4 either way.
TEST(StageLadder, ABandStoresFewOfTheGridsNodes) {
  FieldGrid grid;
  grid.voxel = 1e-3;
  grid.origin = Vec3::Constant(-0.0745);
  grid.nodes = {150, 150, 150};
  const SurfaceField field = sampleFunction([](const Vec3& p) { return p.norm() - 0.05; }, grid, 4);
  std::size_t in_band = 0;
  for (const auto& block : field.distance)
    for (const float phi : block->phi) in_band += std::abs(phi) <= 4.0F;
  std::printf("%zu of %zu nodes in the band, %zu stored in blocks\n", in_band, grid.nodeCount(),
              field.blockCount() * kBlockNodes);
  EXPECT_NEAR(static_cast<double>(in_band), 2.5e5, 0.05e5);
  EXPECT_LT(5 * field.blockCount() * kBlockNodes, grid.nodeCount());
}

} // namespace
} // namespace patina
