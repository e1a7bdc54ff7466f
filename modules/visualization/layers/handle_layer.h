// Handle for moving and rotating something: three arrows, three rings and a ball, along the world
// axes, at constant size in the picture. For pictures without perspective.
#pragma once

#include <array>
#include <optional>

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/types.h"

namespace patina {

enum class HandlePart { free, shift_x, shift_y, shift_z, turn_x, turn_y, turn_z };

// View of a handle: `back` is unit, towards the viewer.
struct HandleView {
  Vec3 middle = Vec3::Zero(), back = Vec3::UnitZ();
  double radius = 1; // radius of the rings [m]
};
// Returns the part of the handle at a point of the plane through the middle that faces the viewer.
// Nullopt: nothing is near enough. A ring seen edge-on counts as the half on the far side of its
// arrow.
std::optional<HandlePart> partAt(const HandleView& view, const Vec3& point);
// Motion that moves the part grabbed at `from` to `to`, both points of that plane.
Pose handleMotion(const HandleView& view, HandlePart part, const Vec3& from, const Vec3& to);

class HandleLayer {
 public:
  explicit HandleLayer(vtkRenderer& overlay); // it outlives this layer
  void setPlace(const std::optional<Vec3>& middle);
  void setHighlighted(std::optional<HandlePart> part); // draws the part brighter
  void prepare();                         // call before a render: updates its size and view
  std::optional<HandleView> view() const; // nullopt: hidden

 private:
  vtkRenderer& overlay_;
  std::array<vtkSmartPointer<vtkActor>, 7> parts_; // index: HandlePart
  std::optional<Vec3> middle_;
};

} // namespace patina
