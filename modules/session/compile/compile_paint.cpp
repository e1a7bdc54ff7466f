#include "session/compile/compile_paint.h"

#include <algorithm>
#include <cmath>

#include "geometry/atlas/texel_map.h"
#include "haptics/law/painted_range.h"
#include "haptics/law/relief_stage.h"
#include "session/compile/compile_scene.h"

namespace patina {
namespace {

const ObjectPaint* paintOf(const Scene& scene, std::size_t object) {
  return object < scene.objects.size() ? scene.objects[object].paint.get() : nullptr;
}

bool hasRelief(const Scene& scene) {
  return scene.relief.height != 0 &&
         std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& o) {
           return o.paint && hasRelief(*o.paint, scene.relief.source);
         });
}

bool isPainted(const Scene& scene) {
  return hasRelief(scene) ||
         std::any_of(scene.objects.begin(), scene.objects.end(), [](const SceneObject& o) {
           return o.paint && (o.paint->material || o.paint->textures);
         });
}

const HapticRelief* knownRelief(const CompiledScene* compiled, std::size_t object) {
  return compiled && object < compiled->paint.relief.size() ? &compiled->paint.relief[object]
                                                            : nullptr;
}

std::shared_ptr<const ImageRange> rangeOf(const std::shared_ptr<const TiledImage>& image,
                                          const std::shared_ptr<const TiledImage>& before,
                                          const std::shared_ptr<const ImageRange>& known) {
  if (known && image == before) return known;
  return std::make_shared<const ImageRange>(imageRange(*image, before.get(), known.get()));
}

// Returns the relief's image before smoothing.
HapticRelief sourceOf(const Scene& scene, std::size_t object, const CompiledScene* before) {
  HapticRelief relief;
  const ObjectPaint* paint = paintOf(scene, object);
  if (!paint) return relief;
  static const HapticRelief kNone;
  const HapticRelief* known = knownRelief(before, object);
  if (!known) known = &kNone;
  if (scene.relief.source == ReliefSource::color) relief.grey = known->grey;
  relief.source = reliefOf(*paint, scene.relief.source, &relief.grey);
  if (relief.source)
    relief.source_range = rangeOf(relief.source, known->source, known->source_range);
  return relief;
}

double highestTexture(const Scene& scene) {
  double most = 0;
  for (const SceneObject& object : scene.objects)
    if (object.paint && object.paint->textures)
      most = std::max(most, highest(*object.paint->textures));
  return most;
}

// A sampled image is interpolated by cubics, a baked one bilinearly.
double overshoot(const Scene& scene) {
  return scene.relief.mode == ReliefMode::pulled ? kReliefOvershoot : 1;
}

// Makes one object's haptic paint, with parts reused from an earlier version.
struct Maker {
  const CompiledScene& compiled;
  const CompiledScene* before; // null if nothing can be reused
  HapticPaint& made;

  const HapticObject* earlier(std::size_t i) const {
    return before && i < before->paint.objects.size() ? &before->paint.objects[i] : nullptr;
  }

  std::shared_ptr<const MaterialSamples> material(std::size_t i, const Material& base) const {
    const ObjectPaint* paint = paintOf(compiled.scene, i);
    if (!paint || !paint->material) return nullptr;
    const ObjectPaint* old_paint = before ? paintOf(before->scene, i) : nullptr;
    const HapticObject* old = earlier(i);
    const bool keeps = old && old->material && old_paint && old_paint->material &&
                       old->material->base == base &&
                       old_paint->material->origin() == paint->material->origin() &&
                       old_paint->material->voxel() == paint->material->voxel();
    if (keeps && old_paint->material == paint->material) return old->material;
    return materialSamples(*paint->material, base, keeps ? old_paint->material.get() : nullptr,
                           keeps ? old->material.get() : nullptr);
  }

  void smooth(std::size_t i, HapticRelief& relief) const {
    relief.felt = relief.source;
    relief.haptic_range = relief.source_range;
    const double deviation = compiled.scene.relief.smoothing;
    if (!(deviation > 0)) return;
    const ObjectPaint& paint = *paintOf(compiled.scene, i);
    const ObjectPaint* old_paint = before ? paintOf(before->scene, i) : nullptr;
    const HapticRelief* old = knownRelief(before, i);
    const bool keeps = old && old->smoother && old_paint &&
                       old_paint->layout.uvs == paint.layout.uvs &&
                       old->source->width() == relief.source->width() &&
                       old->source->height() == relief.source->height();
    if (keeps && before->scene.relief.smoothing == deviation) {
      relief.smoother = old->smoother;
      relief.felt = old->source == relief.source
                        ? old->felt
                        : std::make_shared<const TiledImage>(relief.smoother->updateSmoothed(
                              *old->felt, *old->source, *relief.source));
      relief.haptic_range = rangeOf(relief.felt, old->felt, old->haptic_range);
      return;
    }
    auto texels = keeps ? old->smoother->texels()
                        : std::make_shared<const TexelMap>(texelMap(
                              *paint.layout.uvs, relief.source->width(), relief.source->height()));
    relief.smoother = std::make_shared<const ReliefSmoother>(
        compiled.objects[i]->mesh, paint.layout.uvs, std::move(texels), deviation);
    relief.felt = std::make_shared<const TiledImage>(relief.smoother->smoothed(*relief.source));
    relief.haptic_range = rangeOf(relief.felt, nullptr, nullptr);
  }

  // Max |h''| [1/m] of the relief, for the design of a lateral coupling; else 0.
  double maxCurvature(std::size_t i, HapticRelief& relief) const {
    const Scene& scene = compiled.scene;
    if (!(scene.device_model || scene.stabilisers)) return 0;
    const std::shared_ptr<const CornerUvs>& uvs = paintOf(scene, i)->layout.uvs;
    const TiledImage& image = *relief.felt;
    const HapticRelief* old = knownRelief(before, i);
    const bool keeps =
        old && old->curvature_map && old->curvature_map->fits(*uvs, image.width(), image.height());
    relief.curvature_map =
        keeps ? old->curvature_map
              : std::make_shared<const CurvatureMap>(compiled.objects[i]->mesh, uvs, image.width(),
                                                     image.height());
    relief.max_curvatures =
        keeps && old->felt == relief.felt
            ? old->max_curvatures
            : relief.curvature_map->perTile(image, keeps ? old->felt.get() : nullptr,
                                            keeps ? &old->max_curvatures : nullptr);
    return std::abs(scene.relief.height) *
           static_cast<double>(
               *std::max_element(relief.max_curvatures.begin(), relief.max_curvatures.end()));
  }

  std::shared_ptr<const TexturePatches> patches(std::size_t i) const {
    const ObjectPaint& paint = *paintOf(compiled.scene, i);
    if (!paint.textures) return nullptr;
    const HapticObject* old = earlier(i);
    const ObjectPaint* old_paint = before ? paintOf(before->scene, i) : nullptr;
    if (old && old_paint && old_paint->textures == paint.textures)
      for (const auto& known : {old->relief, old->layer})
        if (known && known->textures) return known->textures;
    auto made_now =
        std::make_shared<const TexturePatches>(*compiled.objects[i]->mesh, *paint.textures);
    return made_now->highest() > 0 ? made_now : nullptr;
  }

  // The requested parts of the object's image and textures; null if it has neither.
  std::shared_ptr<const ReliefSurface> pulled(std::size_t i, bool image, bool textures) const {
    const ObjectPaint* paint = paintOf(compiled.scene, i);
    if (!paint) return nullptr;
    auto surface = std::make_shared<ReliefSurface>();
    if (textures) surface->textures = patches(i);
    if (!image && !surface->textures) return nullptr;
    const HapticObject* old = earlier(i);
    const ReliefSurface* known = old && old->relief  ? old->relief.get()
                                 : old && old->layer ? old->layer.get()
                                                     : nullptr;
    const ObjectPaint* old_paint = before ? paintOf(before->scene, i) : nullptr;
    const auto uvs = image ? paint->layout.uvs : nullptr;
    if (known && old_paint && (known->image != nullptr) == image &&
        (!image || old_paint->layout.uvs == uvs))
      surface->faces = known->faces;
    else
      surface->faces = reliefFaces(*compiled.objects[i]->mesh, uvs ? *uvs : CornerUvs());
    if (!image) return surface;
    surface->image = made.relief[i].felt;
    surface->height = compiled.scene.relief.height;
    return surface;
  }
};

std::vector<ReliefInput> sourcesOf(const CompiledScene& compiled, const HapticPaint& paint) {
  std::vector<ReliefInput> sources(compiled.objects.size());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    ReliefInput& source = sources[i];
    source.first_face = compiled.parts[i].first_face;
    source.faces = static_cast<std::int32_t>(compiled.objects[i]->mesh->triangles.size());
    if (i >= paint.relief.size() || !paint.relief[i].felt) continue;
    source.uvs = paintOf(compiled.scene, i)->layout.uvs;
    source.image = paint.relief[i].felt;
    source.range = paint.relief[i].haptic_range;
    source.height = compiled.scene.relief.height;
  }
  return sources;
}

bool sameLayouts(const Scene& a, const Scene& b) {
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    const ObjectPaint* left = paintOf(a, i);
    const ObjectPaint* right = paintOf(b, i);
    const bool relief_left = left && hasRelief(*left, a.relief.source);
    const bool relief_right = right && hasRelief(*right, b.relief.source);
    if (relief_left != relief_right) return false;
    if (relief_left && left->layout.uvs != right->layout.uvs) return false;
  }
  return true;
}

void bake(const CompiledScene& compiled, const CompiledScene* before, HapticPaint& made,
          Progress& progress) {
  const std::vector<ReliefInput> sources = sourcesOf(compiled, made);
  const bool keeps = before && before->paint.bake && sameLayouts(before->scene, compiled.scene);
  if (!keeps) {
    made.bake =
        std::make_shared<const ReliefBake>(compiled.built.field, *compiled.mesh, sources, progress);
    made.field = made.bake->baked(sources);
    return;
  }
  made.bake = before->paint.bake;
  const bool as_it_was =
      before->scene.relief == compiled.scene.relief &&
      std::equal(made.relief.begin(), made.relief.end(), before->paint.relief.begin(),
                 before->paint.relief.end(),
                 [](const HapticRelief& a, const HapticRelief& b) { return a.felt == b.felt; });
  made.field = as_it_was ? before->paint.field
                         : made.bake->updateBaked(*before->paint.field,
                                                  sourcesOf(*before, before->paint), sources);
}

bool sameLayers(const MaterialBlock& a, const MaterialBlock& b) {
  return a.layer == b.layer;
}

std::vector<MaterialMap::Index> blocksApart(const MaterialMap* a, const MaterialMap* b) {
  std::vector<MaterialMap::Index> blocks;
  const auto collect = [&](const MaterialMap* from, const MaterialMap* other, bool both) {
    if (!from) return;
    for (const auto& [index, block] : from->blocks()) {
      const MaterialBlock* match = nullptr;
      if (other) {
        const auto found = other->blocks().find(index);
        if (found != other->blocks().end()) match = &found->second;
      }
      if (!match || (both && !sameLayers(block, *match))) blocks.push_back(index);
    }
  };
  collect(a, b, true);
  collect(b, a, false);
  return blocks;
}

} // namespace

std::size_t HapticPaint::bytes() const {
  std::size_t bytes = bake ? bake->bytes() : 0;
  for (const HapticObject& object : objects) {
    if (object.material) bytes += object.material->bytes();
    for (const auto& surface : {object.relief, object.layer}) {
      if (!surface) continue;
      bytes += patina::bytes(*surface->faces);
      if (surface->textures) bytes += surface->textures->bytes();
    }
  }
  for (const HapticRelief& image : relief) {
    if (image.grey.grey) bytes += image.grey.grey->bytes();
    if (image.smoother) bytes += image.smoother->bytes();
    if (image.curvature_map) bytes += image.curvature_map->bytes();
    if (image.felt && image.felt != image.source) bytes += image.felt->bytes();
  }
  return bytes;
}

namespace {

double textureShare(const Scene& scene) {
  // A layer's height is measured from its lowest point, so it may be twice the peak.
  return highestTexture(scene) * (scene.haptics.texture_gain ? 2 : 1);
}

} // namespace

InteractionRange interactionRange(const Scene& scene, const CompiledScene* before) {
  float most = 0;
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (const HapticRelief relief = sourceOf(scene, i, before); relief.source)
      most = std::max(most, relief.source_range->all.highest());
  const double relief = std::abs(scene.relief.height) * static_cast<double>(most);
  return interactionRange(scene.haptics,
                          overshoot(scene) * relief + textureShare(scene) + roughnessPeak(scene));
}

InteractionRange reachAfter(const CompiledScene& compiled, const Brush& brush) {
  const Scene& scene = compiled.scene;
  InteractionRange reach = interactionRange(scene, &compiled);
  if (brush.mode == StrokeMode::smooth) return reach;
  // Paint may cover a texture, which stays.
  const double texture = textureShare(scene);
  double value = 0; // at most the sum of all layers
  if (scene.relief.source == ReliefSource::color) {
    if (const BrushLayer* layer = layerOf(brush, Tool::color))
      value += overshoot(scene) * std::abs(scene.relief.height) * grey(layer->color);
  } else if (const BrushLayer* layer = layerOf(brush, Tool::relief)) {
    value += overshoot(scene) * std::abs(layer->value);
  }
  if (const BrushLayer* layer = layerOf(brush, Tool::material(MaterialChannel::roughness)))
    value += kRoughnessPeak * std::abs(layer->value);
  reach.max_relief = brush.mode == StrokeMode::add ? reach.max_relief + value
                                                   : std::max(reach.max_relief, value + texture);
  return reach;
}

HapticPaint hapticPaint(const CompiledScene& compiled, const CompiledScene* before,
                        Progress& progress) {
  HapticPaint made;
  made.field = compiled.built.field;
  const Scene& scene = compiled.scene;
  if (!isPainted(scene)) return made;
  // Results for other meshes or poses cannot be reused.
  if (before && before->objects != compiled.objects) before = nullptr;
  const CompiledScene* same_field =
      before && before->built.field == compiled.built.field ? before : nullptr;
  Maker maker{compiled, before, made};
  const bool relief = hasRelief(scene);
  if (relief) made.relief.resize(scene.objects.size());
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    progress.throwIfCancelled();
    HapticObject object;
    object.first_face = compiled.parts[i].first_face;
    object.object_from_world = scene.objects[i].world_from_object.inverse();
    object.material = maker.material(i, baseMaterial(scene.haptics));
    if (relief) made.relief[i] = sourceOf(scene, i, before);
    bool image = false;
    if (relief && made.relief[i].source) {
      maker.smooth(i, made.relief[i]);
      const double highest = overshoot(scene) * std::abs(scene.relief.height) *
                             static_cast<double>(made.relief[i].haptic_range->all.highest());
      image = scene.relief.mode == ReliefMode::pulled && highest > 0;
      object.baked = scene.relief.mode == ReliefMode::baked && highest > 0;
      if (image) {
        object.highest = highest;
        object.max_curvature = maker.maxCurvature(i, made.relief[i]);
      }
    }
    const bool layered = scene.haptics.texture_gain.has_value();
    object.relief = maker.pulled(i, image, !layered);
    if (layered) object.layer = maker.pulled(i, false, true);
    if (object.relief && object.relief->textures)
      object.highest += object.relief->textures->highest();
    if (object.relief && object.relief->textures)
      object.max_curvature += object.relief->textures->maxCurvature();
    made.objects.push_back(std::move(object));
  }
  if (relief && scene.relief.mode == ReliefMode::baked) bake(compiled, same_field, made, progress);
  return made;
}

std::vector<ReliefInput> reliefSources(const CompiledScene& compiled) {
  return sourcesOf(compiled, compiled.paint);
}

std::vector<PaintChange> paintChanges(const Scene& before, const Scene& after) {
  static const ObjectPaint kNothing;
  std::vector<PaintChange> changes;
  for (std::size_t i = 0; i < after.objects.size(); ++i) {
    const ObjectPaint* old = paintOf(before, i);
    const ObjectPaint* now = paintOf(after, i);
    if (old == now) continue;
    const ObjectPaint& a = old ? *old : kNothing;
    const ObjectPaint& b = now ? *now : kNothing;
    PaintChange change;
    change.object = i;
    change.images = a.color != b.color || a.relief != b.relief;
    change.material_blocks = blocksApart(a.material.get(), b.material.get());
    if (change.images || !change.material_blocks.empty()) changes.push_back(std::move(change));
  }
  return changes;
}

} // namespace patina
