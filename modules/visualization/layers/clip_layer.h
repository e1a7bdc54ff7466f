// A clip plane at any angle that hides everything in front of it, with a handle: a ball and an
// arrow along its normal. The ball or the shaft shifts the plane, the arrow's head tilts it.
#pragma once

#include <optional>

#include <vtkActor.h>
#include <vtkPlane.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/types.h"
#include "visualization/values/camera.h"
#include "visualization/values/palette.h"

namespace patina {

struct ClipPlane {
  Vec3 origin = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ(); // unit, towards the hidden side
  bool operator==(const ClipPlane&) const = default;
};

enum class ClipPart { shift, tilt };

// Returns the part of the handle, an arrow of this length, that a view ray hits.
std::optional<ClipPart> clipPartAt(const ClipPlane& plane, double length, const Ray& view_ray);
// Shifts the plane so that the point grabbed on ray `from` moves to ray `to`. If the arrow points
// at the viewer, a move upwards in the picture (`up`, unit) counts.
ClipPlane clipShifted(const ClipPlane& plane, const Ray& from, const Ray& to, const Vec3& up);
// Moves the arrow's head to the view ray; near an axis it snaps to that.
ClipPlane clipTilted(const ClipPlane& plane, double length, const Ray& to);

// Returns the part of the view ray behind the plane. Nullopt: nothing is left.
std::optional<Ray> behind(const ClipPlane& plane, const Ray& view_ray);

class ClipLayer {
 public:
  // scene: renderer of the outline; overlay: renderer of the handle. Both outlive it.
  ClipLayer(vtkRenderer& scene, vtkRenderer& overlay, const ClipPlane& plane);
  ~ClipLayer();
  ClipLayer(const ClipLayer&) = delete;
  ClipLayer& operator=(const ClipLayer&) = delete;

  void set(const ClipPlane& plane);
  const ClipPlane& plane() const { return plane_; }
  double length() const; // arrow length [m], constant in the picture
  void setHighlighted(const std::optional<ClipPart>& part);
  void showHandle(bool on);
  // Call before a render. The outline lies within the box.
  void prepare(const Box3& box, const palette::BackgroundStyle& ground);
  vtkPlane& cut() { return *cut_; } // keeps the part behind

 private:
  vtkRenderer& scene_;
  vtkRenderer& overlay_;
  ClipPlane plane_;
  vtkSmartPointer<vtkPlane> cut_;
  vtkSmartPointer<vtkPolyData> outline_;
  vtkSmartPointer<vtkActor> rim_, ball_, shaft_, head_;
};

} // namespace patina
