#include "session/store/replay.h"

#include <stdexcept>
#include <utility>

#include "field/construction/build_field.h"
#include "haptics/law/snapshot.h"

namespace patina {

namespace {

FieldSpec plainSpec(const CompiledScene& compiled, Box3& box) {
  for (const auto& object : compiled.objects) box.extend(fieldBounds(*object->mesh));
  return compiled.scene.field;
}

bool isOn(const SurfaceField& field, const FieldGrid& grid, double band) {
  const auto is = [&](const FieldGrid& g) {
    return field.grid.origin == g.origin && field.grid.voxel == g.voxel &&
           field.grid.nodes == g.nodes;
  };
  return field.band == band && (is(grid) || is(paddedForSheets(grid, band)));
}

Scene plain(const Scene& scene) {
  Scene result;
  result.objects = scene.objects;
  for (SceneObject& object : result.objects) object.paint = nullptr;
  result.field = scene.field;
  result.redistance = scene.redistance;
  return result;
}

std::shared_ptr<const PaintSurface> plainSurface(const CompiledScene& compiled, const Scene& scene,
                                                 std::shared_ptr<const PaintSurface> earlier,
                                                 Progress& progress) {
  Box3 box;
  const FieldSpec spec = plainSpec(compiled, box);
  const FieldGrid grid = gridAround(box, spec);
  // Several objects have their own combined mesh for each lattice.
  const bool several = compiled.objects.size() > 1;
  if (earlier && earlier->mesh == compiled.mesh &&
      (several || isOn(*earlier->field, grid, spec.band)))
    return earlier;
  std::shared_ptr<const SurfaceField> field = compiled.built.field;
  const bool is_plain = several
                            ? compiled.lattice.anchor == grid.origin &&
                                  compiled.lattice.voxel == grid.voxel && compiled.band == spec.band
                            : isOn(*field, grid, spec.band);
  if (!is_plain) field = compile(plain(scene), progress)->built.field;
  return paintSurface(scene, compiled.mesh, std::move(field), progress);
}

} // namespace

std::shared_ptr<const PaintSurface> paintSurfaceOf(const CompiledScene& compiled,
                                                   const Scene& scene,
                                                   std::shared_ptr<const PaintSurface> earlier,
                                                   bool with_images, Progress& progress) {
  auto surface = plainSurface(compiled, scene, std::move(earlier), progress);
  return with_images ? withImages(*surface, scene, progress) : surface;
}

bool needsImages(const Brush& brush) {
  if (brush.tool != Tool::erase) return layerOf(brush, Tool::color) || layerOf(brush, Tool::relief);
  return brush.erases.empty() || brush.erases == "color" || brush.erases == "relief";
}

Replayer::Replayer() : cache_(std::make_shared<Cache>()) {}

void Replayer::cacheCompiled(std::shared_ptr<const CompiledScene> compiled,
                             std::shared_ptr<const PaintSurface> surface) {
  *cache_ = {std::move(compiled), std::move(surface)};
}

Scene Replayer::operator()(const Scene& before, const Edit& edit) const {
  if (const auto* values = std::get_if<ValueEdit>(&edit)) {
    Scene after = before;
    setValues(after, values->values);
    return after;
  }
  const auto* stroke = std::get_if<Stroke>(&edit);
  if (!stroke) throw std::invalid_argument("Replayer: the scene of a SceneEdit was not kept");
  Progress progress;
  if (!cache_->compiled || !canReuseField(*cache_->compiled, before))
    *cache_ = {compile(before, progress), nullptr};
  cache_->surface = paintSurfaceOf(*cache_->compiled, before, std::move(cache_->surface),
                                   needsImages(stroke->brush), progress);
  return painted(cache_->surface, before, *stroke);
}

} // namespace patina
