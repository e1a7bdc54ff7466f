#include "app/cli/output/paint_report.h"

#include <algorithm>

#include "authoring/relief/relief_limits.h"
#include "core/numbers.h"

namespace patina::cli {

namespace {

void add(std::vector<LayerBytes>& layers, const std::string& name, std::size_t bytes) {
  if (bytes == 0) return;
  const auto same = std::find_if(layers.begin(), layers.end(),
                                 [&](const LayerBytes& layer) { return layer.name == name; });
  if (same == layers.end())
    layers.push_back({name, bytes});
  else
    same->bytes += bytes;
}

void addPainted(std::vector<LayerBytes>& layers, const ObjectPaint& paint) {
  if (paint.color) add(layers, "color", paint.color->bytes());
  if (paint.relief) add(layers, "relief", paint.relief->bytes());
  if (paint.layout.uvs && paint.layout.made)
    add(layers, "chart atlas", paint.layout.uvs->size() * sizeof((*paint.layout.uvs)[0]));
  if (!paint.material) return;
  for (const MaterialChannel channel : kAllMaterialChannels) {
    std::size_t blocks = 0;
    for (const auto& [index, block] : paint.material->blocks())
      blocks += block.layer[static_cast<std::size_t>(channel)] != nullptr;
    add(layers, std::string(name(channel)), blocks * sizeof(MaterialLayer));
  }
}

// The worst of all objects: the one that exceeds what is admissible by most, else the highest.
struct Worst {
  ReliefLimit limit;
  std::string object;
};

double excess(const ReliefLimit& limit) {
  return limit.admissible ? limit.highest / *limit.admissible : 0;
}

std::optional<Worst> worstRelief(const CompiledScene& compiled) {
  std::optional<Worst> worst;
  for (std::size_t i = 0; i < compiled.paint.relief.size(); ++i) {
    if (!compiled.paint.relief[i].felt) continue;
    const SceneObject& object = compiled.scene.objects[i];
    const ReliefLimit limit =
        reliefLimit(*compiled.objects[i]->mesh, object.paint->layout,
                    *compiled.paint.relief[i].felt, compiled.scene.relief.height,
                    compiled.scene.device_model, compiled.scene.haptics.force_limit);
    const bool worse = !worst || std::pair(excess(limit), limit.highest) >
                                     std::pair(excess(worst->limit), worst->limit.highest);
    if (limit.highest > 0 && worse) worst = Worst{limit, object.name};
  }
  return worst;
}

} // namespace

std::vector<LayerBytes> paintLayers(const CompiledScene& compiled) {
  std::vector<LayerBytes> layers;
  for (const SceneObject& object : compiled.scene.objects)
    if (object.paint) addPainted(layers, *object.paint);
  const FeltPaint& felt = compiled.paint;
  for (const FeltObject& object : felt.objects) {
    if (object.material) add(layers, "felt material", object.material->bytes());
    if (object.relief) add(layers, "felt relief", bytes(*object.relief->faces));
  }
  for (const FeltRelief& relief : felt.relief) {
    if (relief.grey.grey) add(layers, "grey of colour", relief.grey.grey->bytes());
    if (relief.felt != relief.source) add(layers, "smoothed relief", relief.felt->bytes());
    if (relief.smoother) add(layers, "relief smoothing", relief.smoother->bytes());
    if (relief.bend_map) add(layers, "relief curvature", relief.bend_map->bytes());
  }
  if (felt.bake) {
    add(layers, "relief bake", felt.bake->bytes());
    const auto own = [](const SurfaceField& field) { return field.bytes(); };
    if (felt.field != compiled.built.field) add(layers, "baked field", own(*felt.field));
  }
  return layers;
}

const Keys& reliefKeys() {
  static const Keys keys = {{"object", "", "object", "", Shown::never},
                            {"highest", "m", "relief", "at most"},
                            {"wavelength", "m", "wavelength", "", Shown::never},
                            {"admissible", "m", "admissible", "with a device", Shown::never},
                            {"exceeded", "", "exceeded", "", Shown::never}};
  return keys;
}

std::optional<Report> reliefReport(const CompiledScene& compiled) {
  const std::optional<Worst> worst = worstRelief(compiled);
  if (!worst) return std::nullopt;
  const ReliefLimit& limit = worst->limit;
  const bool exceeded = excess(limit) > 1;
  std::string text = formatLength(limit.highest) + " at most, as curved as a wave of " +
                     formatLength(limit.wavelength);
  if (limit.admissible)
    text += "; at " + formatNumber(compiled.scene.haptics.force_limit) +
            " N, the force limit, the device bears " + formatLength(*limit.admissible) +
            (exceeded ? ": it will buzz, smooth it" : "");
  Report report(reliefKeys());
  report.set("object", worst->object).set("highest", limit.highest, text);
  report.set("wavelength", limit.wavelength);
  if (limit.admissible) report.set("admissible", *limit.admissible).set("exceeded", exceeded);
  return report;
}

} // namespace patina::cli
