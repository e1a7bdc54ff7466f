// Draws the stored nodes of the field near the tip.
#pragma once

#include <vector>

#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "field/store/surface_field.h"

namespace patina {

// A stored node of the field.
struct FieldNode {
  Vec3 position; // [m]
  float phi = 0; // voxels
};
// Returns stored nodes within radius_voxels of a point; empty if it is not finite or far from all.
std::vector<FieldNode> nodesNear(const SurfaceField& field, const Vec3& point,
                                 double radius_voxels);

// Draws the field's nodes near the tip, which the contact computation uses (K26).
class NodeLayer {
 public:
  explicit NodeLayer(vtkRenderer& overlay);
  void update(const SurfaceField& field, const Vec3& tip);
  void setVisible(bool on) { actor_->SetVisibility(on); }

 private:
  vtkSmartPointer<vtkPolyData> data_;
  vtkSmartPointer<vtkPolyDataMapper> mapper_;
  vtkSmartPointer<vtkActor> actor_;
};

} // namespace patina
