// Draws planes of the field as images in space, with one scalar bar.
#pragma once

#include <array>
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
#include "scene/slice_position.h"
#include "visualization/layers/clip_layer.h"
#include "visualization/values/paint_quantity.h"
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
  // scene: renderer of the planes; overlay: renderer of the scalar bar.
  SliceLayer(vtkRenderer& scene, vtkRenderer& overlay);

  // A band is tinted from the surface to its edge, which is a line.
  void update(const SurfaceField& field, const Slices& places,
              const std::optional<TouchBand>& band = {},
              const std::optional<SliceMaterial>& material = {}, const ColorScale& scale = {});
  ValueRange range() const { return range_; } // range of the distances' colours [m]
  void setVisible(bool on);
  vtkScalarBarActor& bar() { return *bar_; }
  // Clip planes for the surfaces, one for each slice, slightly behind it.
  std::vector<vtkPlane*> cuts();
  // Turns them so that they hide what is in front of a slice. Returns true if that changes a side.
  bool turnCuts(const Vec3& eye, const SurfaceField& field);
  // Returns true if the point is in front of the plane of a slice.
  bool hides(const Vec3& point, const Vec3& eye) const;
  // A point of a slice that shows a value there.
  struct Hit {
    std::size_t slice = 0;
    Vec3 point = Vec3::Zero();
  };
  // Returns the first one along the ray; `beyond` becomes the part of the ray behind all planes, as
  // seen from the eye.
  std::optional<Hit> hitAlong(const SurfaceField& field, const Vec3& eye, const Ray& ray,
                              std::optional<Ray>& beyond) const;

 private:
  struct Plane {
    explicit Plane(vtkRenderer& scene);
    ClipPlane seenFrom(const Vec3& eye) const; // its normal is towards the eye
    bool has_picture() const { return texture->GetNumberOfInputConnections(0) > 0; }

    vtkSmartPointer<vtkPlaneSource> quad;
    vtkSmartPointer<vtkTexture> texture;
    vtkSmartPointer<vtkActor> actor;
    vtkSmartPointer<vtkPlane> cut;
    double shown = 0;      // largest |phi| that is drawn [voxels]
    bool is_there = false; // one of the slices
    bool keeps_positive = true;
  };

  std::vector<Plane> planes_; // kMaxSlices
  vtkSmartPointer<vtkScalarBarActor> bar_;
  ValueRange range_;
  bool shows_distance_ = true; // with its bar
};

} // namespace patina
