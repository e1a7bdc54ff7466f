// The brush of each tool: all share size and shape, each has its own value and mode.
#pragma once

#include <map>
#include <set>

#include "authoring/brush/surface_values.h"
#include "scene/stroke.h"

namespace patina {

class BrushPresets {
 public:
  // Sets sizes for an object `extent` [m] long, and values that differ from the scene's own.
  void scaleTo(double extent, const HapticProperties& haptics);

  Brush brush(Tool tool) const;
  // Sets the brush of its tool, and size and shape of all. Other tools keep their values.
  void set(const Brush& brush);

  double extent() const { return extent_; }
  double press = 0.8; // Force with which the mouse presses the tool on [N].

 private:
  double extent_ = 0.1;
  Brush common_;
  std::set<Tool> also_;
  std::map<Tool, Brush> own_;
};

// True if a stroke of `brush` can also paint with `tool`.
bool canJoin(const Brush& brush, Tool tool);
// Returns `brush` with the painted value at a point, if its tool paints it.
Brush picked(Brush brush, const SurfaceValues& values);
// Radius at which the weight is one half, 0 < d < r; 0 if there is none.
double halfRadius(const Brush& brush, double radius);

} // namespace patina
