#include "session/build/compile_warnings.h"

#include <gtest/gtest.h>

#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

Scene plate(double thickness, double voxel) {
  Scene scene;
  scene.field.voxel = voxel;
  scene.objects.push_back({"plate",
                           std::make_shared<const TriangleMesh>(box(Vec3(0.04, 0.03, thickness))),
                           Pose::Identity()});
  return scene;
}

std::vector<std::string> warningsOf(const Scene& scene) {
  Progress progress;
  return compileWarnings(*compile(scene, progress));
}

TEST(CompileWarnings, PartsThatVanishBetweenTheNodesAreTold) {
  const auto lines = warningsOf(plate(0.3e-3, 1e-3));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("thinner than a voxel (1 mm)"), std::string::npos) << lines[0];
  EXPECT_TRUE(warningsOf(plate(3e-3, 1e-3)).empty());
  EXPECT_TRUE(warningsOf(plate(0.3e-3, 0.1e-3)).empty());
}

TEST(CompileWarnings, PartsThatAreFeltTooThickAreTold) {
  const auto lines = warningsOf(plate(1e-3, 0.75e-3));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("thinner than two voxels (1.5 mm)"), std::string::npos) << lines[0];
  EXPECT_TRUE(warningsOf(plate(2e-3, 0.75e-3)).empty());
  Scene round;
  round.field.resolution = 60;
  round.objects.push_back(
      {"torus", std::make_shared<const TriangleMesh>(torus(0.03, 0.01, 64, 32)), Pose::Identity()});
  EXPECT_TRUE(warningsOf(round).empty());
}

TEST(CompileWarnings, AnOffsetMakesThinPartsFelt) {
  Scene scene = plate(0.3e-3, 1e-3);
  scene.haptics.offset = 2e-3;
  EXPECT_TRUE(warningsOf(scene).empty());
}

TEST(CompileWarnings, HalfAMagnetIsTold) {
  Scene scene = plate(5e-3, 1e-3);
  scene.haptics.magnet = Magnet{2e-3, 0, false};
  ASSERT_EQ(warningsOf(scene).size(), 1u);
  EXPECT_NE(warningsOf(scene)[0].find("magnet.strength"), std::string::npos);
  scene.haptics.magnet->strength = 300;
  EXPECT_TRUE(warningsOf(scene).empty());
}

TEST(CompileWarnings, APoseInMillimetresIsTold) {
  Scene scene = plate(5e-3, 1e-3);
  scene.field = FieldSpec{};
  scene.objects.push_back(scene.objects[0]);
  scene.objects[1].name = "far";
  scene.objects[1].world_from_object.translation() = Vec3(20, 0, 0);
  const auto lines = warningsOf(scene);
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("metres"), std::string::npos);
}

} // namespace
} // namespace patina
