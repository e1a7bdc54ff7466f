// What each tool paints with: one size and shape for all of them, a value and a mode for each.
#pragma once

#include <map>

#include "authoring/surface_values.h"
#include "scene/stroke.h"

namespace patina {

class BrushBook {
 public:
  // Sizes that suit an object `extent` [m] long, and values that are felt beside the scene's own.
  void suit(double extent, const HapticProperties& haptics);

  Brush brush(Tool tool) const;
  void set(const Brush& brush); // of its tool; size and shape of all

  double extent() const { return extent_; }
  double press = 0.8; // [N], with which the mouse presses the tool on

 private:
  double extent_ = 0.1;
  Brush common_;
  std::map<Tool, Brush> own_;
};

// `brush` with what is painted at a place; only what its tool paints.
Brush picked(Brush brush, const SurfaceValues& values);
// 0 < d < r where the weight is one half; 0 where it nowhere is.
double halfRadius(const Brush& brush, double radius);

} // namespace patina
