#include "scene/scene.h"

#include <cmath>
#include <functional>

#include "core/error.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

std::string sceneError(const Scene& scene) {
  try {
    validate(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

SceneObject object(const std::string& name) {
  return {name, std::make_shared<const TriangleMesh>(box(Vec3(1, 1, 1))), Pose::Identity()};
}

TEST(Scene, DefaultsAreValid) {
  EXPECT_EQ(sceneError(Scene{}), "");
}

TEST(Scene, RejectsInvalidValuesAndNamesTheirKey) {
  const auto broken = [](const std::function<void(Scene&)>& change) {
    Scene scene;
    change(scene);
    return sceneError(scene);
  };
  for (const double value : {-1.0, 1.1e7, std::nan(""), HUGE_VAL}) {
    EXPECT_TRUE(broken([=](Scene& s) { s.haptics.stiffness = value; }).starts_with("stiffness = "));
    EXPECT_TRUE(broken([=](Scene& s) { s.haptics.damping = value; }).starts_with("damping = "));
    EXPECT_TRUE(broken([=](Scene& s) { s.haptics.tip_radius = value; }).starts_with("tip.radius"));
    EXPECT_TRUE(
        broken([=](Scene& s) { s.haptics.force_limit = value; }).starts_with("force.limit"));
    EXPECT_TRUE(broken([=](Scene& s) { s.field.band = value; }).starts_with("band = "));
    EXPECT_TRUE(broken([=](Scene& s) { s.field.voxel = value; }).starts_with("voxel = "));
    EXPECT_TRUE(broken([=](Scene& s) {
                  s.haptics.friction = Friction{value, 0};
                }).starts_with("friction.static"));
  }
  EXPECT_TRUE(broken([](Scene& s) {
                s.haptics.friction = Friction{0.3, 0.5};
              }).starts_with("friction.dynamic = 0.5: it must be at most friction.static"));
  EXPECT_TRUE(broken([](Scene& s) { s.field.voxel = 0; }).starts_with("voxel"));
  EXPECT_TRUE(broken([](Scene& s) { s.field.resolution = 18; }).starts_with("resolution = 18"));
  EXPECT_TRUE(broken([](Scene& s) { s.haptics.force_limit = 0; }).starts_with("force.limit"));
}

TEST(Scene, ExtremesInRangeAreValid) {
  Scene scene;
  scene.haptics.stiffness = 1e7;
  scene.haptics.damping = 0;
  scene.haptics.friction = Friction{0.5, 0.5, 3};
  scene.haptics.tip_radius = 0;
  scene.field.resolution = 19;
  EXPECT_EQ(sceneError(scene), "");
  scene.field.resolution = 4095;
  EXPECT_EQ(sceneError(scene), "");
}

TEST(Scene, RefusesBadObjects) {
  Scene scene;
  scene.objects = {object("cup"), object("cup")};
  EXPECT_EQ(sceneError(scene), "object name 'cup' is used twice");
  for (const char* name : {"", "a b", "../cup", "cup.ply", "t\xE4sse", "a\n"}) {
    scene.objects = {object(name)};
    EXPECT_TRUE(sceneError(scene).starts_with("object name")) << name;
  }
  scene.objects = {object("t\xC3\xA4sse")}; // letters of any language, in UTF-8
  EXPECT_EQ(sceneError(scene), "");
  scene.objects = {{"cup", nullptr, Pose::Identity()}};
  EXPECT_EQ(sceneError(scene), "object 'cup' has no triangles");
  scene.objects[0].mesh = std::make_shared<const TriangleMesh>();
  EXPECT_EQ(sceneError(scene), "object 'cup' has no triangles");
}

TEST(Scene, RejectsNonRigidPoses) {
  Scene scene;
  scene.objects = {object("cup")};
  Pose& pose = scene.objects[0].world_from_object;
  pose.rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())).pretranslate(Vec3(1, 2, 3));
  EXPECT_EQ(sceneError(scene), "");
  const Pose rigid = pose;
  pose.linear() *= 2;
  EXPECT_NE(sceneError(scene), "");
  pose = rigid;
  pose.linear().col(0) *= -1; // a mirror
  EXPECT_NE(sceneError(scene), "");
  pose = rigid;
  pose.translation().x() = std::nan("");
  EXPECT_NE(sceneError(scene), "");
}

} // namespace
} // namespace patina
