#include "scene/edit.h"

#include "core/numbers.h"

namespace patina {
namespace {

std::string describeLayer(const BrushLayer& layer, const Brush& brush) {
  std::string text(name(layer.tool));
  if (brush.mode == StrokeMode::smooth) return text + " smoothed";
  if (layer.tool == Tool::color) return text;
  if (brush.mode == StrokeMode::add) text += layer.value < 0 ? " less" : " more by";
  const std::optional<MaterialChannel> channel = channelOf(layer.tool);
  if (!channel || unit(*channel) == "m") return text + " " + formatLength(layer.value);
  const std::string_view measure = unit(*channel);
  return text + " " + formatNumber(layer.value) +
         (measure.empty() ? "" : " " + std::string(measure));
}

std::string describeStroke(const Stroke& stroke) {
  const Brush& brush = stroke.brush;
  std::string text;
  if (brush.tool == Tool::erase)
    text = brush.erases.empty() ? "erase" : "erase " + brush.erases;
  else
    for (const BrushLayer& layer : layersOf(brush))
      text += (text.empty() ? "" : ", ") + describeLayer(layer, brush);
  return text + ", " + formatLength(brush.radius);
}

std::string describeValues(const ValueEdit& edit) {
  if (edit.values.empty()) return "no change"; // its keys no longer exist
  std::string text;
  for (const auto& [key, value] : edit.values)
    text += (text.empty() ? "" : ", ") + (key + " = " + value);
  return text;
}

} // namespace

std::string describe(const Edit& edit) {
  if (const auto* stroke = std::get_if<Stroke>(&edit)) return describeStroke(*stroke);
  if (const auto* values = std::get_if<ValueEdit>(&edit)) return describeValues(*values);
  return std::get<SceneEdit>(edit).what;
}

} // namespace patina
