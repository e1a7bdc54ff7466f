// What each tool paints with: one size and shape for all of them, a value and a mode for each.
#pragma once

#include <map>
#include <set>

#include "authoring/brush/surface_values.h"
#include "scene/stroke.h"

namespace patina {

class BrushPresets {
 public:
  // Sizes that suit an object `extent` [m] long, and values that are felt beside the scene's own.
  void suit(double extent, const HapticProperties& haptics);

  Brush brush(Tool tool) const;
  // Of its tool; size and shape of all. What it paints also is painted with other tools, too, each
  // layer with its own tool's value.
  void set(const Brush& brush);

  double extent() const { return extent_; }
  double press = 0.8; // [N], with which the mouse presses the tool on

 private:
  double extent_ = 0.1;
  Brush common_;
  std::set<Tool> also_;
  std::map<Tool, Brush> own_;
};

// Whether one stroke may lay on `tool` beside what the brush does.
bool canJoin(const Brush& brush, Tool tool);
// `brush` with what is painted at a place; only what its tool paints.
Brush picked(Brush brush, const SurfaceValues& values);
// 0 < d < r where the weight is one half; 0 where it nowhere is.
double halfRadius(const Brush& brush, double radius);

} // namespace patina
