#include "session/edit/reread_object.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/error.h"

namespace patina {

double unitRatio(MeshUnit was, MeshUnit now) {
  return inMetres({}, now).scale / inMetres({}, was).scale;
}

Scene withReread(Scene scene, const std::string& object, MeshUnit was, MeshUnit now, UpAxis up) {
  const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                  [&](const SceneObject& o) { return o.name == object; });
  if (found == scene.objects.end()) throw Error(object + " is no longer in the scene");
  if (was != now) {
    if (!scene.scans.empty())
      throw Error("the scan " + scene.scans.front().name +
                  " is placed on the mesh in its present size: remove the scans first");
    TriangleMesh mesh = *found->mesh;
    const double per_unit = inMetres({}, was).scale;
    for (Vec3& p : mesh.positions) p /= per_unit;
    found->mesh = std::make_shared<const TriangleMesh>(inMetres(std::move(mesh), now).mesh);
  }
  if (up == UpAxis::y) {
    Pose upright = Pose::Identity();
    upright.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    found->world_from_object = upright * found->world_from_object;
  }
  return scene;
}

} // namespace patina
