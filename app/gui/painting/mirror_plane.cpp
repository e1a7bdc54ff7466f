#include "app/gui/painting/mirror_plane.h"

#include "field/construction/build_field.h"

namespace patina {
namespace {
constexpr double kBeyond = 1.15; // Size of the plane relative to the box.
} // namespace

MirrorState mirrorPlane(const SceneObject& object, Symmetry symmetry) {
  const Box3 box = fieldBounds(*object.mesh);
  const int axis = static_cast<int>(symmetry) - static_cast<int>(Symmetry::x);
  const Vec3 half = 0.5 * kBeyond * box.sizes();
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  MirrorState corners;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    Vec3 at = box.center();
    at[u] += k == 1 || k == 2 ? half[u] : -half[u];
    at[v] += k >= 2 ? half[v] : -half[v];
    corners[k] = object.world_from_object * at;
  }
  return corners;
}

} // namespace patina
