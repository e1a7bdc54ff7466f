#include "haptics/law/painted_range.h"

#include <algorithm>

#include "haptics/law/relief_stage.h"

namespace patina {

bool PaintedRange::any() const {
  return std::find(painted.begin(), painted.end(), true) != painted.end();
}

double maxTextureCurvature(const HapticObject& object) {
  double max_curvature = object.relief ? object.max_curvature : 0;
  if (object.material) max_curvature += kRoughnessMaxCurvature * object.material->max.roughness;
  return max_curvature;
}

PaintedRange paintedRange(const Material& base, std::span<const HapticObject> objects) {
  PaintedRange range;
  range.min = range.max = base;
  for (const HapticObject& object : objects) {
    range.max_curvature = std::max(range.max_curvature, maxTextureCurvature(object));
    range.baked = range.baked || object.baked;
    if (object.relief) {
      range.relief = std::max(range.relief, object.highest);
      if (const auto& textures = object.relief->textures) {
        range.texture_stiffness = std::max(range.texture_stiffness, textures->stiffest());
        range.max.stiffness = std::max(range.max.stiffness, textures->stiffest());
      }
    }
    if (object.layer) range.layer = std::max(range.layer, 2 * object.layer->textures->highest());
    if (!object.material) continue;
    for (const MaterialChannel channel : kAllMaterialChannels) {
      const auto c = static_cast<std::size_t>(channel);
      range.painted[c] = range.painted[c] || object.material->painted[c];
      double& least = valueOf(range.min, channel);
      double& most = valueOf(range.max, channel);
      least = std::min(least, valueOf(object.material->min, channel));
      most = std::max(most, valueOf(object.material->max, channel));
    }
  }
  return range;
}

double roughnessPeak(const Scene& scene) {
  float most = 0;
  for (const SceneObject& object : scene.objects) {
    if (!object.paint || !object.paint->material) continue;
    for (const auto& [index, block] : object.paint->material->blocks())
      if (const auto& layer = block.layer[static_cast<std::size_t>(MaterialChannel::roughness)])
        most = std::max(most, *std::max_element(layer->value.begin(), layer->value.end()));
  }
  return kRoughnessPeak * static_cast<double>(most);
}

HapticProperties worstCase(HapticProperties haptics, const PaintedRange& range) {
  haptics.stiffness = range.max.stiffness;
  if (range.has(MaterialChannel::damping)) haptics.damping = range.min.damping;
  return haptics;
}

} // namespace patina
