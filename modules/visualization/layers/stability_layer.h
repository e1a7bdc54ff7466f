// Where a surface would buzz: K*(x)/K as colour (MATH 2.1.7).
#pragma once

#include <vector>

#include <vtkActor.h>
#include <vtkLookupTable.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Beyond these a colour no longer changes: there is no doubt left.
inline constexpr double kLeastRatioShown = 0.25, kMostRatioShown = 4;

// In the place of a ratio: where the tip slips off, and where nothing can be pressed.
inline constexpr float kSlips = -1, kUntouched = -2;

// Logarithmic, pale at 1, warm below (buzzes), cool above; the construction of the distance map.
vtkSmartPointer<vtkLookupTable> stabilityColors();

class StabilityLayer {
 public:
  // scene: where the surface is; overlay: where the scalar bar is.
  StabilityLayer(vtkRenderer& scene, vtkRenderer& overlay);

  // One ratio a vertex, or what stands in its place; NaN: the force jumps. Each of these that there
  // is has its colour in the legend. Throws std::invalid_argument for another number of them.
  void update(const TriangleMesh& surface, const std::vector<float>& ratio);
  void setVisible(bool on);
  bool hasTags() const { return tags_; }  // at the scale, which then needs more room
  vtkActor& surface() { return *actor_; } // to be cut by the slice
  vtkScalarBarActor& bar() { return *bar_; }

 private:
  vtkSmartPointer<vtkActor> actor_;
  vtkSmartPointer<vtkScalarBarActor> bar_;
  bool tags_ = false;
};

} // namespace patina
