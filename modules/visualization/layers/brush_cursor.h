// Brush cursor on the surface: its outer ring and the ring of half weight.
#pragma once

#include <optional>

#include <vtkActor.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "field/store/surface_field.h"

namespace patina {

struct BrushCursorState {
  Vec3 centre = Vec3::Zero();           // [m], world, on the surface
  Vec3 normal = Vec3::UnitZ();          // unit, outward
  double radius = 0;                    // [m]
  double half_radius = 0;               // weight 1/2 [m]; 0 or the radius: no inner ring
  std::array<double, 3> color{1, 1, 1}; // sRGB, of the disc's faint fill
  bool operator==(const BrushCursorState&) const = default;
};

// The rings lie on the field's surface if it is within a radius, otherwise in the tangent plane.
// They are light on dark, visible on any background and in front of everything. About 0.1 ms.
class BrushCursor {
 public:
  explicit BrushCursor(vtkRenderer& overlay);

  // nullopt: hidden. `field` may be null: a flat ring.
  void update(const std::optional<BrushCursorState>& place, const SurfaceField* field);

 private:
  vtkSmartPointer<vtkPoints> points_;
  vtkSmartPointer<vtkPolyData> rings_, disc_;
  vtkSmartPointer<vtkActor> dark_, light_, fill_;
};

} // namespace patina
