#include "session/build/surface_stability.h"

#include <cmath>

#include "field/surface/iso_surface.h"

namespace patina {

std::optional<SurfaceStability> surfaceStability(const CompiledScene& compiled,
                                                 Progress& progress) {
  const Scene& scene = compiled.scene;
  const auto& field = compiled.paint.field;
  SurfaceStability result;
  result.surface = std::make_shared<const TriangleMesh>(
      isoSurface(*field, scene.haptics.tip_radius.value_or(0)));
  result.map = stabilityMap(scene, field, *result.surface, progress, compiled.paint.objects);
  if (std::isnan(result.map.worst_ratio)) return std::nullopt;
  return result;
}

} // namespace patina
