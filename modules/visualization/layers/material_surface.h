// One object's painted material as felt, at the points of a surface as fine as its grid (K22, K23).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <vtkActor.h>
#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

#include "scene/scene.h"
#include "visualization/values/paint_quantity.h"

namespace patina {

// Boxes in the map's frame, of the places whose value depends on layers of the channel that are not
// the same, by pointer; nullopt if everything may have changed.
std::optional<std::vector<Box3>> changedPlaces(const MaterialMap* before, const MaterialMap& now,
                                               MaterialChannel channel);

class MaterialSurface {
 public:
  MaterialSurface();

  void set(const SceneObject& object, const Material& base);

  // Evaluates what changed; the range of all values, base included.
  ValueRange prepare(MaterialChannel channel);
  void setColors(vtkLookupTable* colors);
  vtkActor& actor() { return *actor_; }

 private:
  void evaluate(MaterialChannel channel, const std::vector<Box3>* places);

  std::shared_ptr<const TriangleMesh> mesh_;
  std::shared_ptr<const MaterialMap> map_;
  Material base_;

  std::shared_ptr<const MaterialMap> shown_; // what the values are of
  std::optional<MaterialChannel> channel_;
  double shown_base_ = 0;
  double fineness_ = 0; // [m], the voxel that the points were made for
  ValueRange range_;

  std::vector<Vec3> points_; // of the surface as drawn, object frame
  vtkSmartPointer<vtkActor> actor_;
};

} // namespace patina
