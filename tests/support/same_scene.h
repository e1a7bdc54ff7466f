// Compares scenes bit for bit: values, meshes, poses and paint.
#pragma once

#include "scene/scene.h"

namespace patina::test {

inline bool same(const Scene& a, const Scene& b) {
  if (values(a) != values(b) || a.objects.size() != b.objects.size()) return false;
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    const SceneObject &left = a.objects[i], &right = b.objects[i];
    if (left.name != right.name || left.mesh->positions != right.mesh->positions ||
        left.mesh->triangles != right.mesh->triangles ||
        left.world_from_object.matrix() != right.world_from_object.matrix() ||
        !left.paint != !right.paint)
      return false;
    if (left.paint && !patina::same(*left.paint, *right.paint)) return false;
  }
  return true;
}

} // namespace patina::test
