#include "session/compile/compile_warnings.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/mesh/shapes.h"
#include "haptics/servo/feel.h"

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

TEST(CompileWarnings, ReportPartsThatVanishBetweenTheNodes) {
  const auto lines = warningsOf(plate(0.3e-3, 1e-3));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("thinner than a voxel (1 mm)"), std::string::npos) << lines[0];
  EXPECT_TRUE(warningsOf(plate(3e-3, 1e-3)).empty());
  EXPECT_TRUE(warningsOf(plate(0.3e-3, 0.1e-3)).empty());
}

TEST(CompileWarnings, ReportPartsThatAreTooThickInTheField) {
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

// A bar along x with sections rotated by `turn`, pressed with K = 500 N/m, 5 mm deep, beside its
// middle.
Scene bar(double thickness, double turn) {
  Scene scene;
  scene.field.voxel = 1e-3;
  scene.haptics.stiffness = 500;
  scene.objects.push_back(
      {"bar", std::make_shared<const TriangleMesh>(box(Vec3(0.06, thickness, thickness))),
       Pose(Eigen::AngleAxisd(turn, Vec3::UnitX()))});
  return scene;
}

// Counts the presses, of 40, that end with less than half of stiffness times depth.
int letGo(const Scene& scene, double thickness, double turn) {
  Progress progress;
  const auto compiled = compile(scene, progress);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1, 1);
  int lost = 0;
  for (int i = 0; i < 40; ++i) {
    const Vec3 from(0.02 * part(random), 0.3 * thickness * part(random), thickness / 2);
    const double lean = 0.2 * part(random);
    std::vector<TimedTip> path;
    for (int k = 0; k <= 600; ++k) {
      const double depth = 1e-5 * k - 1e-3;
      path.push_back(
          {1e-3 * k, Eigen::AngleAxisd(turn, Vec3::UnitX()) * (from + depth * Vec3(lean, 0, -1))});
    }
    const auto felt = feel(*compiled->snapshot, path, progress);
    lost += felt.back().force.norm() < 0.5 * 500 * 5e-3;
  }
  return lost;
}

TEST(CompileWarnings, ReportBarsThatContactCannotHold) {
  int told_that_let_go = 0;
  for (const double turn : {0.0, 0.47})
    for (const double voxels : {2.2, 2.6, 3.2, 4.2, 5.0}) {
      const Scene scene = bar(1e-3 * voxels, turn);
      const auto lines = warningsOf(scene);
      const bool told = !lines.empty() && lines.back().find("bar: a part") == 0;
      const int lost = letGo(scene, 1e-3 * voxels, turn);
      EXPECT_EQ(told, voxels < 4) << voxels << " turned by " << turn;
      if (told) {
        EXPECT_NE(lines.back().find("under four voxels (4 mm)"), std::string::npos);
      } else {
        EXPECT_EQ(lost, 0) << voxels << " turned by " << turn;
      }
      told_that_let_go += told && lost > 0;
    }
  EXPECT_GE(told_that_let_go, 4); // six are reported
}

TEST(CompileWarnings, ExcludePlatesAndPartsThickenedByAnOffset) {
  for (const double thickness : {2.2e-3, 3e-3})
    EXPECT_TRUE(warningsOf(plate(thickness, 1e-3)).empty()) << thickness;
  Scene scene = bar(2.5e-3, 0);
  scene.haptics.offset = 0.5e-3;
  for (const std::string& line : warningsOf(scene))
    EXPECT_EQ(line.find("both ways"), std::string::npos) << line;
  EXPECT_EQ(letGo(scene, 2.5e-3, 0), 0);
}

TEST(CompileWarnings, OffsetMakesThinPartsTangible) {
  Scene scene = plate(0.3e-3, 1e-3);
  scene.haptics.offset = 2e-3;
  EXPECT_TRUE(warningsOf(scene).empty());
}

TEST(CompileWarnings, ReportHalfAMagnet) {
  Scene scene = plate(5e-3, 1e-3);
  scene.haptics.magnet = Magnet{2e-3, 0, false};
  ASSERT_EQ(warningsOf(scene).size(), 1u);
  EXPECT_NE(warningsOf(scene)[0].find("magnet.strength"), std::string::npos);
  scene.haptics.magnet->strength = 300;
  EXPECT_TRUE(warningsOf(scene).empty());
}

TEST(CompileWarnings, ReportALengthLargerThanTheScene) {
  for (const char* key : {"tip.radius", "offset"}) {
    Scene scene = plate(5e-3, 1e-3);
    setValues(scene, {{key, "39mm"}});
    EXPECT_TRUE(warningsOf(scene).empty());
    setValues(scene, {{key, "41mm"}});
    const auto lines = warningsOf(scene);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].find(key), 0u) << lines[0];
  }
}

TEST(CompileWarnings, ReportAPoseInMillimetres) {
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
