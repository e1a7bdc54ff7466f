#include "session/open/surface_stability.h"

#include <cmath>

#include "field/surface/iso_surface.h"
#include "visualization/layers/stability_layer.h"

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

std::vector<float> displayRatios(const StabilityMap& map) {
  std::vector<float> shown = map.ratio;
  for (std::size_t v = 0; v < shown.size(); ++v) {
    if (std::isnan(map.least[v])) shown[v] = kNotTouchable;
    if (map.is_unstable[v] && shown[v] >= 1) shown[v] = kUnstable;
  }
  return shown;
}

} // namespace patina
