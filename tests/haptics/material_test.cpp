// Rendering of painted material: T-K22a to e, F6.
#include <cstdio>

#include <gtest/gtest.h>

#include "haptics/law/painted_range.h"
#include "haptics/law/relief_stage.h"
#include "haptics/painted_fixture.h"
#include "haptics/servo/cross_fade.h"

namespace patina {
namespace {

constexpr double kVoxel = 0x1p-11; // voxel of the plane's field and of the map [m]

std::vector<std::string> names(const HapticSnapshot& snapshot) {
  std::vector<std::string> result;
  for (const StageInfo& stage : snapshot.why) result.push_back(stage.name);
  return result;
}
using Names = std::vector<std::string>;

// K1 for x < 0, K2 for x > 0 and the plane between within one cell.
HapticObject half(const Scene& scene, double k1, double k2) {
  return hapticMaterial(*coveredMap(kVoxel, cube(12e-3), MaterialChannel::stiffness,
                                    [=](const Vec3& p) { return p.x() > 0 ? k2 : k1; }),
                        scene);
}

std::shared_ptr<const HapticSnapshot> compiledWith(const Scene& scene, const HapticObject& object,
                                                   const Field& field = planeField(kVoxel)) {
  return compileStages(scene, field, std::span(&object, 1));
}

TEST(Material, IsAStageOnlyIfPainted) {
  Scene scene = sceneOf(500);
  const HapticObject nothing;
  EXPECT_EQ(names(*compiledWith(scene, nothing)), (Names{"contact", "spring", "limit"}));
  const HapticObject stiff = half(scene, 200, 1000);
  const auto snapshot = compiledWith(scene, stiff);
  EXPECT_EQ(names(*snapshot), (Names{"contact", "material", "spring", "stiffness slope", "limit"}));
  EXPECT_EQ(snapshot->why[1].why, "stiffness painted");
  EXPECT_EQ(snapshot->why[1].bytes, stiff.material->bytes());
  scene.material_form = ForceForm::literal;
  EXPECT_EQ(names(*compiledWith(scene, stiff)), (Names{"contact", "material", "spring", "limit"}));
  const auto painted = [&](MaterialChannel channel) {
    return names(*compiledWith(scene, hapticMaterial(*coveredMap(kVoxel, cube(2e-3), channel,
                                                                 [](const Vec3&) { return 0.25; }),
                                                     scene)));
  };
  EXPECT_EQ(painted(MaterialChannel::static_friction),
            (Names{"contact", "material", "friction", "spring", "limit"}));
  EXPECT_EQ(painted(MaterialChannel::damping),
            (Names{"contact", "material", "spring", "damping", "limit"}));
}

// The range that the band must cover follows from the scene alone.
TEST(Material, RoughnessRangeIsTheSameFromSceneAndSamples) {
  Scene scene = sceneOf(500);
  const auto map = coveredMap(kVoxel, cube(2e-3), MaterialChannel::roughness,
                              [](const Vec3& p) { return p.x() > 0 ? 0x1p-13 : 0x1p-14; });
  EXPECT_EQ(roughnessPeak(scene), 0);
  ObjectPaint paint;
  paint.material = map;
  scene.objects.emplace_back();
  scene.objects.back().paint = std::make_shared<const ObjectPaint>(paint);
  const HapticObject object = hapticMaterial(*map, scene);
  EXPECT_DOUBLE_EQ(roughnessPeak(scene), kRoughnessPeak * 0x1p-13);
  EXPECT_DOUBLE_EQ(reliefOver(std::span(&object, 1)), kRoughnessPeak * 0x1p-13);
  scene.haptics.tip_radius = 1e-3;
  EXPECT_DOUBLE_EQ(interactionRange(scene.haptics, 2e-3).length(), 3e-3);
}

TEST(Material, FindsTheOwnerOnlyAmongSeveralObjects) {
  const Scene scene = sceneOf(500);
  std::vector<HapticObject> objects{half(scene, 200, 1000), HapticObject{}};
  objects[1].first_face = 10;
  EXPECT_EQ(names(*compileStages(scene, planeField(kVoxel), objects)),
            (Names{"contact", "owner", "material", "spring", "stiffness slope", "limit"}));
}

// T-K22b: the painted value is rendered on a fully covered cell.
TEST(Material, RendersThePaintedValue) {
  Scene scene = sceneOf(500);
  const Box3 spot = cube(4e-3);
  auto map =
      coveredMap(kVoxel, spot, MaterialChannel::stiffness, [](const Vec3&) { return 1234.5; });
  coveredMap(
      kVoxel, spot, MaterialChannel::static_friction, [](const Vec3&) { return 0.6; }, map);
  coveredMap(
      kVoxel, spot, MaterialChannel::dynamic_friction, [](const Vec3&) { return 0.35; }, map);
  coveredMap(
      kVoxel, spot, MaterialChannel::damping, [](const Vec3&) { return 2.0; }, map);
  const auto snapshot = compiledWith(scene, hapticMaterial(*map, scene));
  const double d = 1e-3;
  EXPECT_NEAR(touchOnce(*snapshot, Vec3(1e-4, 2e-4, -d)).force.z() / d, 1234.5, 1e-2);
  EXPECT_NEAR(touchOnce(*snapshot, Vec3(9e-3, 2e-4, -d)).force.z() / d, 500, 1e-2);
  ContactMemory memory;
  glide(*snapshot, memory, Vec3(0, 0, 1e-3));
  glide(*snapshot, memory, Vec3(0, 0, -d));
  double most = 0;
  Contact contact;
  for (int i = 1; i <= 1500; ++i) { // 3 mm at 2 um a tick
    contact = tick(*snapshot, memory, Vec3(2e-6 * i, 0, -d), 1e-3);
    most = std::max(most, -contact.force.x() / contact.force.z());
  }
  EXPECT_NEAR(most, 0.6, 0.6e-2);
  EXPECT_NEAR(-contact.force.x() / contact.force.z(), 0.35, 0.35e-2);
  // Damping along the normal: F = K d + B v on the way in.
  const Contact in = tick(*snapshot, memory, Vec3(3e-3, 0, -d - 1e-5), 1e-3);
  EXPECT_NEAR(in.force.z(), 1234.5 * (d + 1e-5) + 2.0 * 1e-2, 1e-3);
}

// T-K22c: linear over one cell and continuous.
TEST(Material, StiffnessIsLinearOverTheCellBetweenTwoPaints) {
  Scene scene = sceneOf(500);
  scene.material_form = ForceForm::literal;
  const auto snapshot = compiledWith(scene, half(scene, 200, 1000));
  const double d = 0.7e-3;
  for (double x = -0.5 * kVoxel; x < 1.5 * kVoxel; x += kVoxel / 64) {
    const double wanted = 200 + 800 * std::clamp(x / kVoxel, 0.0, 1.0);
    EXPECT_NEAR(touchOnce(*snapshot, Vec3(x, 1e-4, -d)).force.z(), wanted * d, 1e-6 * 1000 * d)
        << x;
  }
}

// T-K22d, F6: 1/2 (K2 - K1) d^2 a loop in the paper's form; nothing in the conservative one.
TEST(Material, OnlyTheLiteralFormDoesWorkRoundALoop) {
  Scene scene = sceneOf(500);
  const double k1 = 200, k2 = 1000, d = 1.5e-3;
  const double theory = 0.5 * (k2 - k1) * d * d;
  const HapticObject object = half(scene, k1, k2);
  const std::vector<Vec3> path{Vec3(-2e-3, 1e-4, -d), Vec3(2e-3, 1.3e-4, -d),
                               Vec3(2e-3, 1e-4, 1e-3), Vec3(-2e-3, 1e-4, 1e-3)};
  for (const double offset : {0.0, 0.8e-3}) {
    if (offset > 0) scene.haptics.offset = offset;
    std::vector<Vec3> corners = path;
    for (Vec3& corner : corners) corner.z() += offset;
    scene.material_form = ForceForm::literal;
    const double literal = loopWork(*compiledWith(scene, object), corners);
    scene.material_form = ForceForm::conservative;
    const double conservative = loopWork(*compiledWith(scene, object), corners);
    std::printf("offset %.1f mm: literal %.5g J of %.5g J, conservative %.2g of it\n", 1e3 * offset,
                literal, theory, conservative / theory);
    EXPECT_NEAR(literal, theory, 1e-3 * theory);
    EXPECT_LT(std::abs(conservative), 0.01 * theory);
  }
}

// On a sphere the same holds, where the closest point moves farther or less far than the tip.
TEST(Material, ConservativeFormPullsTheGradientBackThroughTheClosestPoint) {
  Scene scene = sceneOf(500);
  scene.haptics.offset = 2e-3;
  const double R = 0.012;
  const Field sphere = cubeField([=](const Vec3& p) { return p.norm() - R; }, 0.25e-3, 160, 16);
  const HapticObject object =
      hapticMaterial(*coveredMap(0.5e-3, cube(0.016), MaterialChannel::stiffness,
                                 [](const Vec3& p) { return 600 + 4e4 * p.x(); }),
                     scene);
  const auto at = [&](double angle, double r) {
    return Vec3(r * std::sin(angle), 1e-4, r * std::cos(angle));
  };
  for (const double r : {R - 1.5e-3, R + 1e-3}) {
    std::vector<Vec3> path;
    for (int i = -20; i <= 20; ++i) path.push_back(at(0.03 * i, r));
    path.push_back(at(0.6, R + 2.5e-3));
    for (int i = 20; i >= -20; --i) path.push_back(at(0.03 * i, R + 2.5e-3));
    const double d = R + 2e-3 - r;
    const double theory = 0.5 * 8e4 * R * std::sin(0.6) * d * d;
    scene.material_form = ForceForm::literal;
    const double literal = loopWork(*compiledWith(scene, object, sphere), path, 400);
    scene.material_form = ForceForm::conservative;
    const double conservative = loopWork(*compiledWith(scene, object, sphere), path, 400);
    std::printf("r - R = %+.1f mm: literal %.4g J of %.4g J, conservative %.2g of it\n",
                1e3 * (r - R), literal, theory, conservative / theory);
    EXPECT_NEAR(literal, theory, 0.02 * theory);
    EXPECT_LT(std::abs(conservative), 0.01 * theory);
  }
}

// K12, K23: material is that of the closest point on the original surface.
TEST(Material, UsesTheSurfaceBelowAnOffset) {
  Scene scene = sceneOf(500);
  scene.haptics.offset = 2e-3;
  const HapticObject spot =
      hapticMaterial(*coveredMap(kVoxel, Box3(Vec3(-4e-3, -4e-3, -1e-3), Vec3(4e-3, 4e-3, 1e-3)),
                                 MaterialChannel::stiffness, [](const Vec3&) { return 900; }),
                     scene);
  EXPECT_NEAR(touchOnce(*compiledWith(scene, spot), Vec3(1e-4, 0, 1e-3)).force.z(), 0.9, 1e-5);
}

// The painted object is turned and moved; its map lies in its own frame.
TEST(Material, MovesWithItsObject) {
  Scene scene = sceneOf(500);
  HapticObject object = half(scene, 200, 1000);
  Pose world_from_object = Pose::Identity();
  world_from_object.translate(Vec3(2e-3, 1e-3, 0))
      .rotate(Eigen::AngleAxisd(0.5 * std::acos(-1.0), Vec3::UnitZ()));
  object.object_from_world = world_from_object.inverse();
  const auto snapshot = compiledWith(scene, object);
  // The object's x points along the world's y.
  EXPECT_NEAR(touchOnce(*snapshot, Vec3(2e-3, 3e-3, -1e-3)).force.z(), 1.0, 1e-5);
  EXPECT_NEAR(touchOnce(*snapshot, Vec3(2e-3, -1e-3, -1e-3)).force.z(), 0.2, 1e-5);
  const Vec3 between = touchOnce(*snapshot, Vec3(2e-3, 1e-3 + 0.5 * kVoxel, -1e-3)).force;
  EXPECT_NEAR(between.y(), -0.5e-6 * 800 / kVoxel, 1e-6);
  EXPECT_NEAR(between.x(), 0, 1e-9);
}

// Unpainted places of a painted scene give the bits of the unpainted scene.
TEST(Material, ChangesNothingOnUnpaintedPlaces) {
  Scene scene = withFriction(sceneOf(517.3), 0.5, 0.3);
  scene.haptics.damping = 1.1;
  const Field sphere = sphereField();
  const HapticObject spot =
      hapticMaterial(*coveredMap(0.45e-3, Box3(Vec3(0.02, -0.01, -0.01), Vec3(0.03, 0.01, 0.01)),
                                 MaterialChannel::stiffness, [](const Vec3&) { return 517.3F; }),
                     scene);
  const auto plain = compileStages(scene, sphere), painted = compiledWith(scene, spot, sphere);
  ContactMemory a, b;
  std::mt19937 random(4);
  Vec3 tip(-0.0305, 0, 0);
  for (int i = 0; i < 5000; ++i) {
    tip += 1e-4 * randomDirection(random);
    if (std::abs(tip.norm() - 0.03) > 2e-3 || tip.x() > -5e-3) tip = Vec3(-0.0299, 0, 0);
    ASSERT_EQ(tick(*plain, a, tip, 1e-3).force, tick(*painted, b, tip, 1e-3).force) << i;
  }
}

// T-K22e: edits at 30 Hz under a pressed tip.
TEST(Material, EditsUnderAPressedTipRamp) {
  const Scene scene = withFriction(sceneOf(500), 0.4, 0.3);
  const Field plane = planeField(kVoxel);
  auto map = std::make_shared<MaterialMap>(Vec3::Zero(), kVoxel);
  std::vector<std::shared_ptr<const HapticSnapshot>> versions;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> stiffness(100, 2000), friction(0, 1);
  for (int i = 0; i < 60; ++i) {
    const double k = stiffness(random), mu = friction(random);
    const double x = 2e-3 * (i % 5 - 2);
    const Box3 dab(Vec3(x - 3e-3, -3e-3, -3e-3), Vec3(x + 3e-3, 3e-3, 3e-3));
    coveredMap(
        kVoxel, dab, MaterialChannel::stiffness, [=](const Vec3&) { return k; }, map);
    coveredMap(
        kVoxel, dab, MaterialChannel::static_friction, [=](const Vec3&) { return mu; }, map);
    versions.push_back(compiledWith(scene, hapticMaterial(*map, scene), plane));
  }
  CrossFade law;
  const auto first = compileStages(scene, plane);
  law.fadeTo(first.get());
  Vec3 tip(-1e-3, 0, 1e-3);
  for (int i = 0; i < 100; ++i) law.tick(tip += Vec3(1e-5, 0, -2.5e-5), 1e-3);
  Vec3 last = law.tick(tip, 1e-3).force;
  std::size_t next = 0;
  double worst = 0;
  for (int i = 0; next < versions.size(); ++i) {
    if (i % 33 == 0 && !law.fading()) law.fadeTo(versions[next++].get());
    const Contact contact = law.tick(tip, 1e-3);
    ASSERT_FALSE(contact.fault);
    worst = std::max(worst, (contact.force - last).norm());
    last = contact.force;
  }
  EXPECT_LE(worst, 0.05);
  EXPECT_GT(worst, 0.01);
}

} // namespace
} // namespace patina
