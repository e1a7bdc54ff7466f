// A plane at any angle that cuts away what lies ahead of it, with a handle: a ball and an arrow
// along its normal. The ball or the shaft shifts the plane, the arrow's head tilts it.
#pragma once

#include <optional>

#include <vtkActor.h>
#include <vtkPlane.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/types.h"
#include "visualization/values/palette.h"
#include "visualization/view/camera.h"

namespace patina {

struct ClipPlane {
  Vec3 origin = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ(); // unit, towards what is cut away
  bool operator==(const ClipPlane&) const = default;
};

enum class ClipPart { shift, tilt };

// Part of the handle, an arrow of that length, that a line of sight meets.
std::optional<ClipPart> clipPartAt(const ClipPlane& plane, double length, const Ray& sight);
// What is held on the sight `from` goes to `to`. Where the arrow points at the viewer, upwards in
// the picture is along it: `up` is unit.
ClipPlane clipShifted(const ClipPlane& plane, const Ray& from, const Ray& to, const Vec3& up);
// The arrow's head goes to the sight; near an axis it stays on that.
ClipPlane clipTilted(const ClipPlane& plane, double length, const Ray& to);

// Where a line of sight begins once what is ahead of the plane is gone. Nullopt: nothing is left.
std::optional<Ray> behind(const ClipPlane& plane, const Ray& sight);

class ClipLayer {
 public:
  // scene: where the plane's rim is; overlay: where the handle is. Both outlive it.
  ClipLayer(vtkRenderer& scene, vtkRenderer& overlay, const ClipPlane& plane);
  ~ClipLayer();
  ClipLayer(const ClipLayer&) = delete;
  ClipLayer& operator=(const ClipLayer&) = delete;

  void set(const ClipPlane& plane);
  const ClipPlane& plane() const { return plane_; }
  double length() const; // of the arrow [m], as large as it looks
  void setHot(const std::optional<ClipPart>& part);
  // Before a render: the rim lies within the box.
  void prepare(const Box3& box, const palette::Ground& ground);
  vtkPlane& cut() { return *cut_; } // keeps what is behind

 private:
  vtkRenderer& scene_;
  vtkRenderer& overlay_;
  ClipPlane plane_;
  vtkSmartPointer<vtkPlane> cut_;
  vtkSmartPointer<vtkPolyData> outline_;
  vtkSmartPointer<vtkActor> rim_, ball_, shaft_, head_;
};

} // namespace patina
