// Scenes and folders for the tests of the workspace.
#pragma once

#include <filesystem>
#include <unistd.h>

#include "geometry/shapes.h"
#include "scene/scene.h"
#include "workspace/workspace.h"

namespace patina {

inline Scene sceneWithObjects(double radius) {
  Scene scene;
  Pose pose = Pose::Identity();
  pose.translate(Vec3(0.1, -0.2, 1.0 / 3)).rotate(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  scene.objects.push_back(
      {"ball", std::make_shared<const TriangleMesh>(icosphere(radius, 4)), pose});
  scene.objects.push_back({"crate-1",
                           std::make_shared<const TriangleMesh>(box(Vec3(1, 2, 3) * radius)),
                           Pose::Identity()});
  setValues(scene, {{"friction.static", "0.5"}, {"friction.dynamic", "0.3"}, {"band", "6"}});
  scene.haptics.stiffness = 1000 * radius;
  return scene;
}

inline bool same(const Scene& a, const Scene& b) {
  if (values(a) != values(b) || a.objects.size() != b.objects.size()) return false;
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    const SceneObject& x = a.objects[i];
    const SceneObject& y = b.objects[i];
    if (x.name != y.name || x.mesh->positions != y.mesh->positions ||
        x.mesh->triangles != y.mesh->triangles ||
        x.world_from_object.matrix() != y.world_from_object.matrix())
      return false;
  }
  return true;
}

// A folder of its own for each test, gone afterwards.
class WorkspaceTest : public testing::Test {
 protected:
  WorkspaceTest()
      : root(std::filesystem::path(testing::TempDir()) /
             ("patina_workspace_" + std::to_string(getpid()))),
        folder(root / "scene") {
    std::filesystem::create_directories(root);
  }
  ~WorkspaceTest() override { std::filesystem::remove_all(root); }

  std::size_t meshFiles() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder / "meshes"), {}));
  }
  std::filesystem::path root;
  std::filesystem::path folder;
};

} // namespace patina
