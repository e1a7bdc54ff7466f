#include <gtest/gtest.h>

#include "core/error.h"
#include "core/numbers.h"
#include "field/merge/merge_fields.h"
#include "haptics/neutral_stages.h"
#include "haptics/painted_fixture.h"

namespace patina {
namespace {

std::vector<std::string> stageNames(const HapticSnapshot& snapshot) {
  std::vector<std::string> result;
  for (const StageInfo& stage : snapshot.why) result.push_back(stage.name);
  return result;
}

using StageNames = std::vector<std::string>;

TEST(CompileStages, LeavesOutAbsentFeatures) {
  const Field sphere = sphereField(0.03, 60);
  Scene scene = sceneOf(500);
  EXPECT_EQ(stageNames(*compileStages(scene, sphere)), (StageNames{"contact", "spring", "limit"}));
  scene.haptics.damping = 1;
  EXPECT_EQ(stageNames(*compileStages(scene, sphere)),
            (StageNames{"contact", "spring", "damping", "limit"}));
  scene = withFriction(scene, 0.5, 0.3);
  EXPECT_EQ(stageNames(*compileStages(scene, sphere)),
            (StageNames{"contact", "friction", "spring", "damping", "limit"}));
  scene.haptics.damping.reset();
  EXPECT_EQ(stageNames(*compileStages(scene, sphere)),
            (StageNames{"contact", "friction", "spring", "limit"}));
}

TEST(CompileStages, TreatsANeutralValueAsAbsent) {
  Scene scene = withFriction(sceneOf(500), 0, 0);
  scene.haptics.damping = 0;
  EXPECT_EQ(stageNames(*compileStages(scene, sphereField(0.03, 60))),
            (StageNames{"contact", "spring", "limit"}));
}

TEST(CompileStages, ReportsReasonAndMemoryOfEachStage) {
  const Field sphere = sphereField(0.03, 60);
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.5, 0.3), sphere);
  ASSERT_EQ(snapshot->why.size(), 4u);
  EXPECT_NE(dynamic_cast<const FrictionStage*>(snapshot->stages[1].get()), nullptr);
  EXPECT_NE(dynamic_cast<const SpringStage*>(snapshot->stages[2].get()), nullptr);
  EXPECT_EQ(snapshot->why[1].why, "friction.static = 0.5");
  std::size_t read = 0;
  for (const LayerBytes& layer : sphere->layerBytes()) {
    if (layer.name != "distance") read += layer.bytes;
  }
  EXPECT_EQ(snapshot->why[0].bytes, read); // top, sample and coarse
  EXPECT_EQ(snapshot->why[1].bytes, 0u);
}

// A path in and out of the surface, now and then with a jump that faults or skips; it returns to
// `home` wherever `strayed` is true.
void expectSameForces(const HapticSnapshot& pruned, const HapticSnapshot& full, const Vec3& home,
                      const std::function<bool(const Vec3&)>& strayed) {
  EXPECT_LT(pruned.stages.size(), full.stages.size());
  ContactMemory a, b;
  std::mt19937 random(1);
  std::uniform_int_distribution<int> rare(0, 99);
  Vec3 tip = home;
  int touching = 0;
  for (int i = 0; i < 20000; ++i) {
    tip += (rare(random) ? 2e-4 : 8e-3) * randomDirection(random);
    if (strayed(tip)) tip = home;
    const Contact first = tick(pruned, a, tip, 1e-3);
    const Contact second = tick(full, b, tip, 1e-3);
    touching += first.touching;
    ASSERT_EQ(first.force, second.force) << i;
    ASSERT_EQ(first.touching, second.touching) << i;
    if (first.touching) {
      ASSERT_EQ(first.vcp, second.vcp) << i;
    }
    ASSERT_EQ(first.fault, second.fault) << i;
  }
  EXPECT_GT(touching, 2000);
}

// Forces of the pruned pipeline are bitwise those of the full one with neutral values.
TEST(CompileStages, PruningChangesNoForce) {
  const Field sphere = sphereField();
  Scene damped = sceneOf(500);
  damped.haptics.damping = 1.5;
  Scene finite = sceneOf(500);
  finite.haptics.tip_radius = 1e-3;
  Scene warm = sceneOf(500);
  warm.haptics.offset = 1e-3;
  Scene coupled = damped;
  coupled.device_model = DeviceModel{};
  coupled.stabilisers = Stabilisers{true, false};
  Scene watched = withFriction(coupled, 0.5, 0.3);
  watched.stabilisers = Stabilisers{true, true};
  for (const Scene& scene : {sceneOf(500), damped, withFriction(sceneOf(500), 0.5, 0.3), finite,
                             warm, coupled, watched}) {
    const auto pruned = compileStages(scene, sphere);
    const auto full = withNeutralStages(scene, sphere);
    EXPECT_GE(full->stages.size(), 9U); // a coupling is spring and damping in one
    expectSameForces(*pruned, *full, Vec3(0, 0, 0.0302),
                     [](const Vec3& tip) { return std::abs(tip.norm() - 0.03) > 6e-3; });
  }
}

bool strayedFromTop(const Vec3& tip) {
  return std::max(std::abs(tip.x()), std::abs(tip.y())) > 0.015 || std::abs(tip.z()) > 4e-3;
}

TEST(CompileStages, PruningChangesNoForceOfPaint) {
  const Slab& made = fineSlab();
  const Scene scene = sceneOf(500);
  const auto waves = reliefImage(64, [](double u, double v) { return std::sin(20 * u + 9 * v); });
  const HapticObject relief = hapticRelief(made.faces, waves, 0.4e-3);
  const auto painted = [&](MaterialChannel channel, double value) {
    return hapticMaterial(
        *coveredMap(0.5e-3, cube(0.012), channel, [=](const Vec3&) { return value; }), scene);
  };
  HapticObject both = painted(MaterialChannel::stiffness, 900);
  both.relief = relief.relief;
  both.highest = relief.highest;
  for (const HapticObject& object : {relief, painted(MaterialChannel::roughness, 3e-5),
                                     painted(MaterialChannel::stiffness, 900), both}) {
    const std::vector<HapticObject> objects{object};
    expectSameForces(*compileStages(scene, made.field, objects),
                     *withNeutralStages(scene, made.field, objects), Vec3(0, 0, 1e-3),
                     strayedFromTop);
  }
}

TEST(CompileStages, PruningChangesNoForceOfAUnion) {
  TriangleMesh left = box(Vec3(0.03, 0.03, 0.012), 1), right = left;
  for (Vec3& p : left.positions) p += Vec3(-0.008, 0, -0.006);
  for (Vec3& p : right.positions) p += Vec3(0.008, 0, -0.005);
  const BlockLattice lattice{Vec3(-0.04, -0.04, -0.04), 0.5e-3};
  constexpr double kBand = 12;
  Progress progress;
  std::vector<FieldPart> parts;
  std::int32_t first_face = 0;
  for (const TriangleMesh* mesh : {&left, &right}) {
    const BlockBox blocks = blocksAround(lattice, bounds(*mesh), kBand);
    parts.push_back({buildField(*mesh, gridOf(lattice, blocks), kBand, progress).field, blocks.low,
                     first_face});
    first_face += static_cast<std::int32_t>(mesh->triangles.size());
  }
  const Field field =
      withSamples(std::make_shared<const SurfaceField>(mergeFields(parts, lattice)));
  const Scene scene = withFriction(sceneOf(500), 0.4, 0.3);
  std::vector<HapticObject> plain(2);
  plain[1].first_face = parts[1].first_face;
  std::vector<HapticObject> painted = plain;
  painted[1].material = hapticMaterial(*coveredMap(0.5e-3, cube(0.02), MaterialChannel::stiffness,
                                                   [](const Vec3&) { return 800; }),
                                       scene)
                            .material;
  for (const auto& objects : {plain, painted})
    expectSameForces(*compileStages(scene, field, objects),
                     *withNeutralStages(scene, field, objects), Vec3(0, 0, 2e-3), strayedFromTop);
}

TEST(CompileStages, RefusesUnsuitableFields) {
  EXPECT_THROW(compileStages(sceneOf(500), nullptr), std::invalid_argument);
  SurfaceField bare = *sphereField(0.03, 60);
  bare.sample.clear();
  EXPECT_THROW(compileStages(sceneOf(500), std::make_shared<const SurfaceField>(bare)),
               std::invalid_argument);
}

TEST(CompileStages, NamesATipWiderThanTheBandWithTheRemedy) {
  Scene scene = sceneOf(500);
  const Field sphere = sphereField(0.03, 60); // h = 1.36 mm, band 8
  scene.haptics.tip_radius = 7.5e-3;
  try {
    compileStages(scene, sphere);
    FAIL() << "accepted";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("tip.radius"), std::string::npos) << text;
    EXPECT_NE(text.find("set band to 9"), std::string::npos) << text;
  }
}

// The tip's radius comes first, then all that reaches farther; the named band suffices, and no
// smaller one does.
TEST(CompileStages, NamesEveryFeatureBeyondTheBand) {
  Scene scene = sceneOf(500);
  scene.haptics.tip_radius = 3e-3;
  scene.haptics.offset = 2e-3;
  scene.haptics.magnet = Magnet{4e-3, 500};
  HapticObject object = hapticMaterial(*coveredMap(0.5e-3, cube(0.012), MaterialChannel::roughness,
                                                   [](const Vec3&) { return 2e-4; }),
                                       scene);
  object.relief =
      hapticRelief(fineSlab().faces, reliefImage(64, [](double, double) { return 1; }), 1e-3)
          .relief;
  object.highest = 1e-3;
  const double peak = kRoughnessPeak * object.material->max.roughness;
  const auto fieldOf = [](double band) {
    return cubeField([](const Vec3& p) { return p.z(); }, 1e-3, 64, band);
  };
  const auto refusal = [&](double band) -> std::string {
    try {
      compileStages(scene, fieldOf(band), std::vector<HapticObject>{object});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  // 3 + 1 + peak + 4 voxels of reach, and 3 beyond.
  const int needed = static_cast<int>(std::ceil(8 + peak / 1e-3 + 3));
  EXPECT_EQ(refusal(8), "tip.radius = 3 mm with offset = 2 mm with magnet.range = 4 mm with "
                        "relief, highest = 1 mm with roughness, peak = " +
                            formatLength(peak) +
                            " does not fit into the band of 8 voxels; set band to " +
                            std::to_string(needed) + " or more");
  EXPECT_EQ(refusal(needed), "");
  EXPECT_NE(refusal(needed - 1), "");
  scene.haptics.tip_radius.reset();
  scene.haptics.magnet.reset();
  scene.haptics.offset = 9e-3;
  EXPECT_EQ(refusal(8).substr(0, 42), "offset = 9 mm with relief, highest = 1 mm ");
}

// The tick is a pure function of snapshot, memory, tip and dt.
TEST(Tick, RepeatsItselfBitForBit) {
  Scene scene = withFriction(sceneOf(500), 0.5, 0.3);
  scene.haptics.damping = 1;
  const auto snapshot = compileStages(scene, sphereField());
  const auto run = [&] {
    std::vector<Vec3> forces;
    ContactMemory memory;
    std::mt19937 random(2);
    Vec3 tip(0, 0, 0.0305);
    for (int i = 0; i < 3000; ++i) {
      tip += 1e-4 * randomDirection(random) - 2e-5 * (tip.norm() - 0.029) / 1e-3 * tip.normalized();
      forces.push_back(tick(*snapshot, memory, tip, 1e-3).force);
    }
    return forces;
  };
  EXPECT_EQ(run(), run());
}

TEST(Tick, ResetRestoresTheFirstTick) {
  const auto snapshot = compileStages(withFriction(sceneOf(500), 0.5, 0.3), sphereField());
  ContactMemory memory;
  const Vec3 tip(0.01, 0.02, 0.018);
  const Vec3 first = tick(*snapshot, memory, tip, 1e-3).force;
  glide(*snapshot, memory, Vec3(0.015, 0.02, 0.01));
  memory.reset();
  EXPECT_EQ(tick(*snapshot, memory, tip, 1e-3).force, first);
}

} // namespace
} // namespace patina
