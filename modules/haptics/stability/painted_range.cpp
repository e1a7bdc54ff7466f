#include "haptics/stability/painted_range.h"

#include <algorithm>

#include "haptics/stages/relief_stage.h"

namespace patina {

bool PaintedRange::any() const {
  return std::find(painted.begin(), painted.end(), true) != painted.end();
}

double textureBend(const FeltObject& object) {
  double bend = object.relief ? object.bend : 0;
  if (object.material) bend += kRoughnessBend * object.material->most.roughness;
  return bend;
}

PaintedRange paintedRange(const Material& base, std::span<const FeltObject> objects) {
  PaintedRange range;
  range.least = range.most = base;
  for (const FeltObject& object : objects) {
    range.bend = std::max(range.bend, textureBend(object));
    range.baked = range.baked || object.baked;
    if (object.relief) {
      range.relief = std::max(range.relief, object.highest);
      if (const auto& textures = object.relief->textures) {
        range.texture_stiffness = std::max(range.texture_stiffness, textures->stiffest());
        range.most.stiffness = std::max(range.most.stiffness, textures->stiffest());
      }
    }
    if (object.layer) range.layer = std::max(range.layer, 2 * object.layer->textures->highest());
    if (!object.material) continue;
    for (const MaterialChannel channel : kAllMaterialChannels) {
      const auto c = static_cast<std::size_t>(channel);
      range.painted[c] = range.painted[c] || object.material->painted[c];
      double& least = valueOf(range.least, channel);
      double& most = valueOf(range.most, channel);
      least = std::min(least, valueOf(object.material->least, channel));
      most = std::max(most, valueOf(object.material->most, channel));
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

HapticProperties hardest(HapticProperties haptics, const PaintedRange& range) {
  haptics.stiffness = range.most.stiffness;
  if (range.has(MaterialChannel::damping)) haptics.damping = range.least.damping;
  return haptics;
}

} // namespace patina
