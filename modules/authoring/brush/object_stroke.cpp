#include "authoring/brush/object_stroke.h"

#include <algorithm>

namespace patina {
namespace {

std::vector<MaterialInk> inksOf(const Brush& brush, const MaterialMap* map) {
  std::vector<MaterialInk> inks;
  for (const BrushLayer& layer : layersOf(brush))
    if (const std::optional<MaterialChannel> channel = channelOf(layer.tool))
      inks.push_back({*channel, layer.value});
  for (const MaterialChannel channel : kAllMaterialChannels)
    if (map && erases(brush, Tool::material(channel)) && map->has(channel))
      inks.push_back({channel, 0});
  return inks;
}

template <typename T> void join(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

} // namespace

bool erases(const Brush& brush, Tool tool) {
  return brush.tool == Tool::erase && (brush.erases.empty() || brush.erases == name(tool));
}

bool changesImages(const Brush& brush, const ObjectPaint* paint) {
  return layerOf(brush, Tool::color) || layerOf(brush, Tool::relief) ||
         (paint && ((paint->color && erases(brush, Tool::color)) ||
                    (paint->relief && erases(brush, Tool::relief))));
}

ObjectStroke::ObjectStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
                           std::shared_ptr<const ObjectPaint> start, const StrokeTask& task)
    : surface_(std::move(surface)), object_(object), brush_(task.brush), paint_(std::move(start)) {
  static const ObjectPaint kBare{};
  const ObjectPaint& paint = paint_ ? *paint_ : kBare;
  if (const BrushLayer* layer = layerOf(brush_, Tool::color)) {
    const auto& [red, green, blue] = layer->color;
    color_.emplace(surface_, object, paint.color, kColorChannels,
                   Ink{{red, green, blue, 1}, false});
  } else if (paint.color && erases(brush_, Tool::color)) {
    color_.emplace(surface_, object, paint.color, kColorChannels, Ink{{}, true});
  }
  if (const BrushLayer* layer = layerOf(brush_, Tool::relief))
    relief_.emplace(surface_, object, paint.relief, 1,
                    Ink{{layer->value / task.relief_height, 0, 0, 0}, false});
  else if (paint.relief && erases(brush_, Tool::relief))
    relief_.emplace(surface_, object, paint.relief, 1, Ink{{}, true});
  std::vector<MaterialInk> inks = inksOf(brush_, paint.material.get());
  if (!inks.empty())
    material_.emplace(surface_, object, paint.material, task.base, std::move(inks));
}

void ObjectStroke::paint(const Dab& dab, std::span<const std::int32_t> faces, PaintReport& report) {
  if (color_) report.texels += color_->paint(dab, brush_, faces);
  if (relief_) report.texels += relief_->paint(dab, brush_, faces);
  if (material_) report.nodes += material_->paint(dab, brush_);
}

std::shared_ptr<const ObjectPaint> ObjectStroke::paint() {
  const auto changed = [](const auto& part) { return part && part->changed(); };
  if (!changed(color_) && !changed(relief_) && !changed(material_)) return paint_;
  auto next = std::make_shared<ObjectPaint>(paint_ ? *paint_ : ObjectPaint{});
  if (changed(color_)) next->color = color_->take();
  if (changed(relief_)) next->relief = relief_->take();
  if (changed(material_)) next->material = material_->take();
  const bool images = next->color || next->relief;
  if (!images) next->layout = {};
  if (images && !next->layout.uvs) next->layout = surface_->objects[object_].layout;
  paint_ = images || next->material || next->textures ? std::move(next) : nullptr;
  return paint_;
}

void ObjectStroke::finish() {
  if (brush_.tool != Tool::erase) return;
  if (color_) color_->dropEmpty();
  if (relief_) relief_->dropEmpty();
  if (material_) material_->dropEmpty();
}

void ObjectStroke::collect(PaintChange& change) {
  if (color_) {
    join(change.color_tiles, color_->takeTiles());
    change.region.extend(color_->takeRegion());
  }
  if (relief_) {
    join(change.relief_tiles, relief_->takeTiles());
    change.region.extend(relief_->takeRegion());
  }
  if (material_) {
    join(change.material_blocks, material_->takeBlocks());
    change.region.extend(material_->takeRegion());
  }
}

} // namespace patina
