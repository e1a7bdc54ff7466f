// A handle to shift and turn something by: three arrows, three rings about them and a ball between,
// which look as large from everywhere. World axes; a picture without perspective.
#pragma once

#include <array>
#include <optional>

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/types.h"

namespace patina {

enum class HandlePart { free, shift_x, shift_y, shift_z, turn_x, turn_y, turn_z };

// A line of sight onto a handle: `back` is unit, towards the viewer.
struct HandleView {
  Vec3 middle = Vec3::Zero(), back = Vec3::UnitZ();
  double radius = 1; // of its rings [m]
};
// What is held there: a point of the plane through the middle that faces the viewer. Nullopt:
// nothing is that near. A ring that is seen edge on is half a line, on the far side of its arrow.
std::optional<HandlePart> partAt(const HandleView& view, const Vec3& point);
// What brings the part that is held at `from` to `to`, points of the same plane.
Pose handleMotion(const HandleView& view, HandlePart part, const Vec3& from, const Vec3& to);

class HandleLayer {
 public:
  explicit HandleLayer(vtkRenderer& overlay); // which outlives it
  void setPlace(const std::optional<Vec3>& middle);
  void setHot(std::optional<HandlePart> part); // is drawn brighter
  void prepare();                              // before a render: its size and what can be held
  std::optional<HandleView> view() const;      // nullopt: it is not there

 private:
  vtkRenderer& overlay_;
  std::array<vtkSmartPointer<vtkActor>, 7> parts_; // by HandlePart
  std::optional<Vec3> middle_;
};

} // namespace patina
