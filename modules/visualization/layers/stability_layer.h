// Stability map: K*(x)/K as colour (MATH 2.1.7).
#pragma once

#include <vector>

#include <vtkActor.h>
#include <vtkLookupTable.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Range of the colours; beyond it stability is certain or excluded.
inline constexpr double kMinRatioShown = 0.25, kMaxRatioShown = 4;

// Special values: the equilibrium is unstable; the vertex cannot be pressed.
inline constexpr float kUnstable = -1, kNotTouchable = -2;

// Logarithmic, pale at 1, warm below (unstable), cool above; built like the distance map.
vtkSmartPointer<vtkLookupTable> stabilityColors();

class StabilityLayer {
 public:
  // scene: renderer of the surface; overlay: renderer of the scalar bar.
  StabilityLayer(vtkRenderer& scene, vtkRenderer& overlay);

  // `ratio`: one value per vertex, or a special value; NaN: the force is discontinuous. The legend
  // lists the special values that occur. Throws std::invalid_argument for a wrong count.
  void update(const TriangleMesh& surface, const std::vector<float>& ratio);
  void setVisible(bool on) {
    actor_->SetVisibility(on);
    bar_->SetVisibility(on);
  }
  bool hasTags() const { return tags_; }  // special values in the legend, which needs more space
  vtkActor& surface() { return *actor_; } // the slice cuts it
  vtkScalarBarActor& bar() { return *bar_; }

 private:
  vtkSmartPointer<vtkActor> actor_;
  vtkSmartPointer<vtkScalarBarActor> bar_;
  bool tags_ = false;
};

} // namespace patina
