#include "app/gui/painting/brush_presets.h"

#include <algorithm>
#include <cmath>

#include "authoring/brush/painter.h"
#include "visualization/values/palette.h"

namespace patina {
namespace {

// Rounds to two digits, as a person would type.
double rounded(double value) {
  if (!(value > 0)) return value;
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return unit * std::round(value / unit);
}

} // namespace

void BrushPresets::scaleTo(double extent, const HapticProperties& haptics) {
  extent_ = extent;
  common_ = {};
  also_.clear();
  common_.radius = rounded(0.04 * extent);
  common_.falloff = 2;
  own_.clear();
  const auto own = [this](Tool tool, double value) {
    Brush& brush = own_[tool];
    brush.tool = tool;
    brush.value = value;
  };
  own(Tool::color, 0);
  own_[Tool::color].color = {0.80, 0.22, 0.16};
  own(Tool::relief, rounded(std::clamp(0.006 * extent, 1e-4, 2e-3)));
  for (const Channel& row : kChannels) own(Tool::material(row.channel), row.default_value);
  own(Tool::material(MaterialChannel::stiffness), rounded(2.5 * haptics.stiffness));
  own(Tool::erase, 0);
}

Brush BrushPresets::brush(Tool tool) const {
  Brush brush = common_;
  brush.tool = tool;
  const auto own = own_.find(tool);
  if (own == own_.end()) return brush;
  brush.color = own->second.color;
  brush.value = own->second.value;
  brush.mode = own->second.mode;
  brush.erases = own->second.erases;
  brush.extra_layers.clear();
  for (const Tool other : also_)
    if (canJoin(brush, other)) brush.extra_layers.push_back(own_.at(other));
  return brush;
}

void BrushPresets::set(const Brush& brush) {
  common_ = brush;
  own_[brush.tool] = brush;
  for (const auto& [tool, own] : own_)
    if (canJoin(brush, tool)) {
      also_.erase(tool);
      if (layerOf(brush, tool)) also_.insert(tool);
    }
}

bool canJoin(const Brush& brush, Tool tool) {
  return tool != brush.tool && tool != Tool::erase && brush.tool != Tool::erase &&
         !(tool == Tool::color && brush.mode == StrokeMode::add);
}

Brush picked(Brush brush, const SurfaceValues& values) {
  if (brush.tool == Tool::color) {
    const double bare = 1 - values.color[3];
    for (std::size_t i = 0; i < 3; ++i)
      brush.color[i] = std::clamp(values.color[i] + bare * palette::kSurface[i], 0.0, 1.0);
  } else if (brush.tool == Tool::relief) {
    brush.value = values.height;
  } else if (const auto channel = channelOf(brush.tool)) {
    brush.value = valueOf(values.material, *channel);
  }
  return brush;
}

double halfRadius(const Brush& brush, double radius) {
  double low = 0, high = radius;
  if (!(radius > 0)) return 0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (brushWeight(brush, middle, radius) > 0.5 ? low : high) = middle;
  }
  return low;
}

} // namespace patina
