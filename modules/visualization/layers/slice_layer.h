// Draws a plane of the field as an image in space, with a scalar bar.
#pragma once

#include <optional>
#include <vector>

#include <vtkActor.h>
#include <vtkLookupTable.h>
#include <vtkPlane.h>
#include <vtkPlaneSource.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>
#include <vtkTexture.h>

#include "field/store/surface_field.h"
#include "scene/color_scale.h"
#include "scene/scene.h"
#include "visualization/layers/clip_layer.h"
#include "visualization/values/paint_quantity.h"
#include "visualization/values/slice_position.h"
#include "visualization/values/touch_band.h"

namespace patina {

// Distance on a plane at points one voxel apart, interpolated linearly between nodes; NaN where a
// node is not stored. On a plane across an axis, columns and rows are the grid's.
struct FieldPlane {
  Vec3 normal = Vec3::UnitY();
  Vec3 origin = Vec3::Zero(), across = Vec3::Zero(), up = Vec3::Zero(); // corner and sides [m]
  int columns = 0, rows = 0;                                            // points along the sides
  std::vector<float> phi;                                               // voxels, columns fastest
};
// The rectangle contains the plane's part in the grid. A position outside the grid is moved to its
// end.
FieldPlane planeOf(const SurfaceField& field, const SlicePosition& place);
// Values at n x n points within each cell of the plane, linear between its corners; cells without
// a value at a corner have none.
std::vector<float> refinedValues(const FieldPlane& plane, int n);
Box3 boxOf(const FieldGrid& grid); // from the first to the last node [m]
// Range of positions along a normal in which a plane meets the grid [m].
ValueRange rangeOf(const FieldGrid& grid, const Vec3& normal);
// The same position with a value, within that range.
SlicePosition within(const FieldGrid& grid, SlicePosition place);

// Shows painted material instead of distance, in the colours of its surface.
struct SliceMaterial {
  const Scene* scene;
  MaterialChannel channel;
  vtkLookupTable* colors; // maps values in SI
};

class SliceLayer {
 public:
  // scene: renderer of the plane; overlay: renderer of the scalar bar.
  SliceLayer(vtkRenderer& scene, vtkRenderer& overlay);

  // A band is tinted from the surface to its edge, which is a line.
  void update(const SurfaceField& field, const SlicePosition& place,
              const std::optional<TouchBand>& band = {},
              const std::optional<SliceMaterial>& material = {}, const ColorScale& scale = {});
  ValueRange range() const { return range_; } // range of the distances' colours [m]
  void setVisible(bool on);
  // Clip plane for the surfaces, which the view places.
  vtkPlane& plane() { return *plane_; }
  vtkScalarBarActor& bar() { return *bar_; }
  const Vec3& origin() const { return origin_; } // a point of the plane [m]
  // Plane of the slice with its normal towards the eye.
  ClipPlane planeSeenFrom(const Vec3& eye) const;
  // Returns true if the slice shows a value at this point of its plane.
  bool covers(const SurfaceField& field, const Vec3& point) const;

 private:
  vtkSmartPointer<vtkPlaneSource> quad_;
  vtkSmartPointer<vtkTexture> texture_;
  vtkSmartPointer<vtkActor> actor_;
  vtkSmartPointer<vtkScalarBarActor> bar_;
  vtkSmartPointer<vtkPlane> plane_;
  Vec3 origin_ = Vec3::Zero();
  ValueRange range_;
  double shown_ = 0;           // largest |phi| that is drawn [voxels]
  bool shows_distance_ = true; // with its bar
};

} // namespace patina
