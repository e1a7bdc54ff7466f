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

Scene withReread(Scene scene, const std::string& object, const TriangleMesh* asked, MeshUnit was,
                 MeshUnit now, UpAxis up) {
  const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                  [&](const SceneObject& o) { return o.name == object; });
  if (found == scene.objects.end()) throw Error(object + " is no longer in the scene");
  if (found->mesh.get() != asked)
    throw Error("the mesh of " + object + " has changed since the question: ask again");
  if (was == now && up == UpAxis::z) return scene;
  if (!scene.scans.empty())
    throw Error("the scan " + scene.scans.front().name +
                " is placed on the mesh as it is: remove the scans first");
  if (!scene.pins.empty() && scene.objects.size() > 1)
    throw Error("the pin " + scene.pins.front().name +
                " may lie on the object as it is: remove the pins first");
  const Pose before = found->world_from_object;
  double scale = 1;
  if (was != now) {
    TriangleMesh mesh = *found->mesh;
    const double per_unit = inMetres({}, was).scale;
    for (Vec3& p : mesh.positions) p /= per_unit;
    ScaledMesh scaled = inMetres(std::move(mesh), now);
    scale = scaled.scale / per_unit;
    found->mesh = std::make_shared<const TriangleMesh>(std::move(scaled.mesh));
  }
  Pose upright = Pose::Identity();
  if (up == UpAxis::y) upright.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  found->world_from_object = before * upright;
  for (Pin& pin : scene.pins)
    pin.position = found->world_from_object * (scale * (before.inverse() * pin.position));
  return scene;
}

} // namespace patina
