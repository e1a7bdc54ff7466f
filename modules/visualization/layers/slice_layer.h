// A plane of the field as a picture in space, with its scalar bar.
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
#include "scene/scene.h"
#include "visualization/values/touch_band.h"
#include "visualization/view/scene_view.h"

namespace patina {

// Distance on one plane, blended linearly between nodes; NaN where a node is not stored.
struct FieldPlane {
  int columns = 0, rows = 0; // nodes along the plane's two axes
  std::vector<float> phi;    // voxels, columns fastest
};
FieldPlane planeOf(const SurfaceField& field, const SlicePlace& place);

// Painted material in place of distance: where something is painted in the colours of its surface.
struct SliceMaterial {
  const Scene* scene;
  MaterialChannel channel;
  vtkLookupTable* colors; // of values in SI
};

class SliceLayer {
 public:
  // scene: where the plane stands; overlay: where the scalar bar does.
  SliceLayer(vtkRenderer& scene, vtkRenderer& overlay);

  // A band is tinted from the surface to its edge, and the edge is a line.
  void update(const SurfaceField& field, const SlicePlace& place,
              const std::optional<TouchBand>& band = {},
              const std::optional<SliceMaterial>& material = {});
  void setVisible(bool on);
  // The plane itself, to cut the surfaces with; its normal is the slice's axis.
  vtkPlane& plane() { return *plane_; }
  vtkScalarBarActor& bar() { return *bar_; }
  double position() const { return position_; } // along the axis [m]

 private:
  vtkSmartPointer<vtkPlaneSource> quad_;
  vtkSmartPointer<vtkTexture> texture_;
  vtkSmartPointer<vtkActor> actor_;
  vtkSmartPointer<vtkScalarBarActor> bar_;
  vtkSmartPointer<vtkPlane> plane_;
  double position_ = 0;
  bool shows_distance_ = true; // with its bar
};

} // namespace patina
