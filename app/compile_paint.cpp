#include "app/compile_paint.h"

#include <algorithm>

#include "app/compile_scene.h"
#include "authoring/relief_limits.h"
#include "haptics/painted_range.h"
#include "haptics/relief_stage.h"

namespace patina {
namespace {

const ObjectPaint* paintOf(const Scene& scene, std::size_t object) {
  return object < scene.objects.size() ? scene.objects[object].paint.get() : nullptr;
}

bool hasRelief(const Scene& scene) {
  return scene.relief.height != 0 &&
         std::any_of(scene.objects.begin(), scene.objects.end(),
                     [](const SceneObject& o) { return o.paint && o.paint->relief; });
}

bool isPainted(const Scene& scene) {
  return hasRelief(scene) ||
         std::any_of(scene.objects.begin(), scene.objects.end(),
                     [](const SceneObject& o) { return o.paint && o.paint->material; });
}

float highestIn(const TiledImage& image, std::size_t tile) {
  float most = 0;
  if (const auto& values = image.sharedTile(tile))
    for (const float g : *values) most = std::max(most, std::abs(g));
  return most;
}

// Greatest |g|; of an image that shares tiles with `before`, whose own is known, only the others
// are looked at.
float highest(const TiledImage& image, const TiledImage* before, float highest_before) {
  const bool shares = before && before->tileCount() == image.tileCount();
  float most = shares ? highest_before : 0;
  for (std::size_t i = 0; i < image.tileCount(); ++i)
    if (!shares || image.sharedTile(i) != before->sharedTile(i))
      most = std::max(most, highestIn(image, i));
  return most;
}

// By object.
std::vector<float> highestOf(const Scene& scene, const CompiledScene* before) {
  std::vector<float> result(scene.objects.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const ObjectPaint* paint = paintOf(scene, i);
    if (!paint || !paint->relief) continue;
    const bool known = before && i < before->paint.highest.size();
    const ObjectPaint* old = known ? paintOf(before->scene, i) : nullptr;
    result[i] = highest(*paint->relief, old ? old->relief.get() : nullptr,
                        known ? before->paint.highest[i] : 0);
  }
  return result;
}

// A pulled image is read through cubics, a baked one bilinearly.
double overshoot(const Scene& scene) {
  return scene.relief.mode == ReliefMode::pulled ? kReliefOvershoot : 1;
}

// One object's share of the work, with what an earlier version may lend.
struct Maker {
  const CompiledScene& compiled;
  const CompiledScene* before; // null where nothing of it can be kept
  FeltPaint& made;

  const FeltObject* earlier(std::size_t i) const {
    return before && i < before->paint.objects.size() ? &before->paint.objects[i] : nullptr;
  }

  std::shared_ptr<const MaterialSamples> material(std::size_t i, const Material& base) const {
    const ObjectPaint* paint = paintOf(compiled.scene, i);
    if (!paint || !paint->material) return nullptr;
    const ObjectPaint* old_paint = before ? paintOf(before->scene, i) : nullptr;
    const FeltObject* old = earlier(i);
    const bool keeps = old && old->material && old_paint && old_paint->material &&
                       old->material->base == base &&
                       old_paint->material->origin() == paint->material->origin() &&
                       old_paint->material->voxel() == paint->material->voxel();
    if (keeps && old_paint->material == paint->material) return old->material;
    return materialSamples(*paint->material, base, keeps ? old_paint->material.get() : nullptr,
                           keeps ? old->material.get() : nullptr);
  }

  // The image as it is felt.
  std::shared_ptr<const TiledImage> image(std::size_t i) const {
    const ObjectPaint& paint = *paintOf(compiled.scene, i);
    const double deviation = compiled.scene.relief.smoothing;
    if (!(deviation > 0)) return paint.relief;
    const ObjectPaint* old = before ? paintOf(before->scene, i) : nullptr;
    const bool same_layout = old && old->layout.uvs == paint.layout.uvs;
    if (same_layout && old->relief == paint.relief && i < before->paint.relief.size() &&
        before->scene.relief.smoothing == deviation)
      return before->paint.relief[i];
    const TriangleMesh& mesh = *compiled.objects[i]->mesh;
    std::shared_ptr<const TexelMap> texels;
    if (same_layout && i < before->paint.texels.size()) texels = before->paint.texels[i];
    if (!texels)
      texels = std::make_shared<const TexelMap>(
          texelMap(*paint.layout.uvs, paint.relief->width(), paint.relief->height()));
    made.texels[i] = texels;
    return std::make_shared<const TiledImage>(
        smoothed(*paint.relief, mesh, paint.layout, *texels, deviation));
  }

  std::shared_ptr<const ReliefSurface> pulled(std::size_t i) const {
    const ObjectPaint& paint = *paintOf(compiled.scene, i);
    auto surface = std::make_shared<ReliefSurface>();
    const FeltObject* old = earlier(i);
    const ObjectPaint* old_paint = before ? paintOf(before->scene, i) : nullptr;
    if (old && old->relief && old_paint && old_paint->layout.uvs == paint.layout.uvs)
      surface->faces = old->relief->faces;
    else
      surface->faces = reliefFaces(*compiled.objects[i]->mesh, *paint.layout.uvs);
    surface->image = made.relief[i];
    surface->height = compiled.scene.relief.height;
    return surface;
  }
};

std::vector<ReliefSource> sourcesOf(const CompiledScene& compiled, const FeltPaint& paint) {
  std::vector<ReliefSource> sources(compiled.objects.size());
  std::int32_t first = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    ReliefSource& source = sources[i];
    source.first_face = first;
    source.faces = static_cast<std::int32_t>(compiled.objects[i]->mesh->triangles.size());
    first += source.faces;
    if (i >= paint.relief.size() || !paint.relief[i]) continue;
    source.uvs = paintOf(compiled.scene, i)->layout.uvs;
    source.image = paint.relief[i];
    source.height = compiled.scene.relief.height;
  }
  return sources;
}

bool sameLayouts(const Scene& a, const Scene& b) {
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    const ObjectPaint* left = paintOf(a, i);
    const ObjectPaint* right = paintOf(b, i);
    const bool relief_left = left && left->relief, relief_right = right && right->relief;
    if (relief_left != relief_right) return false;
    if (relief_left && left->layout.uvs != right->layout.uvs) return false;
  }
  return true;
}

void bake(const CompiledScene& compiled, const CompiledScene* before, FeltPaint& made,
          Progress& progress) {
  const std::vector<ReliefSource> sources = sourcesOf(compiled, made);
  const bool keeps = before && before->paint.bake && sameLayouts(before->scene, compiled.scene);
  if (!keeps) {
    made.bake =
        std::make_shared<const ReliefBake>(compiled.built.field, *compiled.mesh, sources, progress);
    made.field = made.bake->baked(sources);
    return;
  }
  made.bake = before->paint.bake;
  const bool as_it_was =
      before->paint.relief == made.relief && before->scene.relief == compiled.scene.relief;
  made.field = as_it_was ? before->paint.field
                         : made.bake->rebaked(*before->paint.field,
                                              sourcesOf(*before, before->paint), sources);
}

// Only where the two differ.
std::vector<std::size_t> tilesApart(const std::shared_ptr<const TiledImage>& a,
                                    const std::shared_ptr<const TiledImage>& b) {
  std::vector<std::size_t> tiles;
  if (a == b) return tiles;
  const TiledImage& any = a ? *a : *b;
  const bool alike = a && b && a->tileCount() == b->tileCount();
  for (std::size_t i = 0; i < any.tileCount(); ++i) {
    if (alike ? a->sharedTile(i) != b->sharedTile(i) : any.sharedTile(i) != nullptr)
      tiles.push_back(i);
  }
  return tiles;
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

std::size_t FeltPaint::bytes() const {
  std::size_t bytes = bake ? bake->bytes() : 0;
  for (const FeltObject& object : objects) {
    if (object.material) bytes += object.material->bytes();
    if (object.relief) bytes += patina::bytes(*object.relief->faces);
  }
  for (const auto& map : texels)
    if (map) bytes += map->owner.size() * sizeof(map->owner[0]);
  return bytes;
}

double reachOf(const Scene& scene, const CompiledScene* before) {
  const std::vector<float> all = highestOf(scene, before);
  const float most = all.empty() ? 0 : *std::max_element(all.begin(), all.end());
  const double relief = std::abs(scene.relief.height) * static_cast<double>(most);
  return reachOf(scene.haptics, overshoot(scene) * relief + roughnessPeak(scene));
}

double reachAfter(const CompiledScene& compiled, const Brush& brush) {
  const Scene& scene = compiled.scene;
  const double now = reachOf(scene, &compiled);
  if (brush.mode == StrokeMode::smooth) return now;
  double value = 0;
  if (brush.tool == Tool::relief) value = overshoot(scene) * std::abs(brush.value);
  if (brush.tool == Tool::roughness) value = kRoughnessPeak * std::abs(brush.value);
  const double bare = reachOf(scene.haptics);
  return brush.mode == StrokeMode::add ? now + value : std::max(now, bare + value);
}

FeltPaint feltPaint(const CompiledScene& compiled, const CompiledScene* before,
                    Progress& progress) {
  FeltPaint made;
  made.field = compiled.built.field;
  const Scene& scene = compiled.scene;
  if (!isPainted(scene)) return made;
  // What was made for other meshes, or for the same ones elsewhere, is of no use.
  if (before && before->objects != compiled.objects) before = nullptr;
  const CompiledScene* same_field =
      before && before->built.field == compiled.built.field ? before : nullptr;
  Maker maker{compiled, before, made};
  const bool relief = hasRelief(scene);
  if (relief) {
    made.highest = highestOf(scene, before);
    made.relief.resize(scene.objects.size());
    made.texels.resize(scene.objects.size());
  }
  std::int32_t first = 0;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    progress.throwIfCancelled();
    FeltObject object;
    object.first_face = first;
    object.object_from_world = scene.objects[i].world_from_object.inverse();
    object.material = maker.material(i, baseMaterial(scene.haptics));
    const ObjectPaint* paint = paintOf(scene, i);
    if (relief && paint && paint->relief) {
      made.relief[i] = maker.image(i);
      const float most =
          made.relief[i] == paint->relief ? made.highest[i] : highest(*made.relief[i], nullptr, 0);
      object.highest = overshoot(scene) * std::abs(scene.relief.height) * static_cast<double>(most);
      if (scene.relief.mode == ReliefMode::pulled && object.highest > 0)
        object.relief = maker.pulled(i);
    }
    first += static_cast<std::int32_t>(compiled.objects[i]->mesh->triangles.size());
    made.objects.push_back(std::move(object));
  }
  if (relief && scene.relief.mode == ReliefMode::baked) bake(compiled, same_field, made, progress);
  return made;
}

std::vector<ReliefSource> reliefSources(const CompiledScene& compiled) {
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
    change.color_tiles = tilesApart(a.color, b.color);
    change.relief_tiles = tilesApart(a.relief, b.relief);
    change.material_blocks = blocksApart(a.material.get(), b.material.get());
    if (!change.color_tiles.empty() || !change.relief_tiles.empty() ||
        !change.material_blocks.empty())
      changes.push_back(std::move(change));
  }
  return changes;
}

} // namespace patina
