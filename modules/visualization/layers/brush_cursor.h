// The brush on the surface: its rim, and where it paints half.
#pragma once

#include <optional>

#include <vtkActor.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "field/store/surface_field.h"

namespace patina {

struct BrushPlace {
  Vec3 centre = Vec3::Zero();  // [m], world, on the surface
  Vec3 normal = Vec3::UnitZ(); // unit, outward
  double radius = 0;           // [m]
  double half_radius = 0;      // [m], where the weight is 1/2; 0 or the radius: no inner ring
  std::array<double, 3> color{1, 1, 1}; // sRGB, of the disc's faint filling
  bool operator==(const BrushPlace&) const = default;
};

// Rings that lie on the field's surface where it is within a radius of them, else in the tangent
// plane. Light on dark, so that they are seen on any ground, and over everything. About 0.1 ms.
class BrushCursor {
 public:
  explicit BrushCursor(vtkRenderer& overlay);

  // nullopt: not shown. `field` may be null: a flat ring.
  void update(const std::optional<BrushPlace>& place, const SurfaceField* field);

 private:
  vtkSmartPointer<vtkPoints> points_;
  vtkSmartPointer<vtkPolyData> rings_, disc_;
  vtkSmartPointer<vtkActor> dark_, light_, fill_;
};

} // namespace patina
