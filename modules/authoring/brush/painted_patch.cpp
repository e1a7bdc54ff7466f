#include "authoring/brush/painted_patch.h"

#include "authoring/brush/surface_values.h"
#include "geometry/measure/patch_area.h"
#include "scene/painted_value.h"

namespace patina {

std::optional<PaintedPatch> paintedPatchAt(const Scene& scene, std::size_t object,
                                           const SurfacePoint& point, const Adjacency& neighbours) {
  const SceneObject& owner = scene.objects.at(object);
  if (!owner.paint || point.face < 0) return std::nullopt;
  const auto patch =
      [&](std::string_view what,
          const std::function<double(const SurfacePoint&)>& cover) -> std::optional<PaintedPatch> {
    if (!(cover(point) >= 0.5)) return std::nullopt;
    return PaintedPatch{std::string(what), patchArea(*owner.mesh, neighbours, point, cover)};
  };
  if (owner.paint->color)
    if (const auto found = patch("color", [&](const SurfacePoint& p) {
          return surfaceValues(scene, object, p).color[3];
        }))
      return found;
  for (const Channel& row : kChannels) {
    if (!owner.paint->material || !owner.paint->material->has(row.channel)) continue;
    if (const auto found = patch(row.key, [&](const SurfacePoint& p) {
          return paintedValue(scene, row.channel,
                              owner.world_from_object * position(*owner.mesh, p))
              .weight;
        }))
      return found;
  }
  const double height = surfaceValues(scene, object, point).height;
  if (height == 0) return std::nullopt;
  return patch("relief", [&](const SurfacePoint& p) {
    return surfaceValues(scene, object, p).height / height;
  });
}

} // namespace patina
