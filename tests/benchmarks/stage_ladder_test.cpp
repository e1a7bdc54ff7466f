// MATH section 3, (b), (c), (e): what a scene does not have costs neither bytes nor nanoseconds.
#include <chrono>
#include <cstdio>

#include <gtest/gtest.h>

#include "app/studies/query_timing.h"
#include "haptics/painted_fixture.h"

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

// A mesh's sphere, painted all over: contact, friction, material, relief, roughness.
TEST(StageLadder, PaintAddsToATickThatStaysWithinAMicrosecond) {
  const double R = 0.03;
  const TriangleMesh mesh = icosphere(R, 100); // 200,000 faces
  FieldSpec spec;
  spec.resolution = 150;
  Progress progress;
  const Field sphere = withSamples(buildField(mesh, spec, progress).field);
  CornerUvs uvs(mesh.triangles.size());
  for (std::size_t f = 0; f < uvs.size(); ++f)
    for (int c = 0; c < 3; ++c) {
      const Vec3 p = mesh.corner(f, c) / (2.1 * R) + Vec3::Constant(0.5);
      uvs[f][static_cast<std::size_t>(c)] = Vec2(p.x(), p.y());
    }
  Scene scene = sceneOf(500);
  const double bare = nsOf(*compileStages(scene, sphere));
  std::printf("%-28s %.1f ns a tick\n", "contact, spring, limit", bare);
  scene = withFriction(scene, 0.5, 0.3);
  double last = bare;
  FeltObject object;
  const auto rung = [&](const char* what) {
    const auto snapshot = compileStages(scene, sphere, std::span(&object, 1));
    const double ns = nsOf(*snapshot);
    std::printf("%-28s %.1f ns a tick (%+.1f)\n", what, ns, ns - last);
    last = ns;
    return ns;
  };
  rung("+ friction");
  const auto all = cube(R + 2e-3);
  const double h = sphere->grid.voxel;
  auto map = coveredMap(h, all, MaterialChannel::stiffness,
                        [](const Vec3& p) { return 600 + 5e3 * p.x(); });
  object = feltMaterial(*map, scene);
  scene.material_form = ForceForm::literal;
  rung("+ stiffness, literal");
  scene.material_form = ForceForm::conservative;
  rung("+ stiffness, conservative");
  coveredMap(
      h, all, MaterialChannel::static_friction, [](const Vec3&) { return 0.5; }, map);
  coveredMap(
      h, all, MaterialChannel::dynamic_friction, [](const Vec3&) { return 0.3; }, map);
  object = feltMaterial(*map, scene);
  rung("+ friction painted");
  const auto image =
      imageOf(512, [](double u, double v) { return std::sin(60 * u) * std::cos(50 * v); });
  const FeltObject raised = feltRelief(reliefFaces(mesh, uvs), image, 0.3e-3);
  object.relief = raised.relief;
  object.highest = raised.highest;
  scene.relief.form = ForceForm::literal;
  rung("+ relief, literal");
  scene.relief.form = ForceForm::conservative;
  rung("+ relief, conservative");
  coveredMap(
      h, all, MaterialChannel::damping, [](const Vec3&) { return 1; }, map);
  coveredMap(
      h, all, MaterialChannel::roughness, [](const Vec3&) { return 2e-5; }, map);
  const auto keep = object.relief;
  object.material = feltMaterial(*map, scene).material;
  const double whole = rung("+ damping, roughness painted");
  EXPECT_LT(whole / bare, 20);
  EXPECT_LT(whole, 3000); // [ns]; the machine is noisy

  // The snapshot itself, which is in the way of every dab.
  using Clock = std::chrono::steady_clock;
  double least_us = 1e9;
  for (int i = 0; i < 50; ++i) {
    const auto start = Clock::now();
    const auto snapshot = compileStages(scene, sphere, std::span(&object, 1));
    const std::chrono::duration<double, std::micro> us = Clock::now() - start;
    least_us = std::min(least_us, us.count());
  }
  std::printf("compileStages: %.1f us at best of 50; material %zu kB, relief %zu kB\n", least_us,
              object.material->bytes() / 1024, bytes(*object.relief->faces) / 1024);
  EXPECT_LT(least_us, 100);
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
