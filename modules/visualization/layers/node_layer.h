// The field's nodes near the tip (K26): what contact computes with.
#pragma once

#include <vtkActor.h>
#include <vtkFloatArray.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "field/store/surface_field.h"

namespace patina {

struct FieldNode {
  Vec3 position; // [m]
  float phi = 0; // voxels
};
// Stored nodes within radius_voxels of a point; empty if it is not finite or far from all of them.
std::vector<FieldNode> nodesNear(const SurfaceField& field, const Vec3& point,
                                 double radius_voxels);

class NodeLayer {
 public:
  explicit NodeLayer(vtkRenderer& overlay);
  void update(const SurfaceField& field, const Vec3& tip);
  void setVisible(bool on);

 private:
  vtkSmartPointer<vtkPolyData> data_;
  vtkSmartPointer<vtkPolyDataMapper> mapper_;
  vtkSmartPointer<vtkActor> actor_;
};

} // namespace patina
