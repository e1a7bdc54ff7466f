// View cube in a corner that rotates with the scene; its sides, edges and corners select a view.
#pragma once

#include <optional>

#include <vtkActor.h>
#include <vtkAnnotatedCubeActor.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/types.h"
#include "visualization/values/camera.h"
#include "visualization/values/text_style.h"

namespace patina {

// Direction from the centre to the side, edge or corner that a ray hits on the cube of side 1 about
// the origin; each component is -1, 0 or 1. Nullopt: it misses.
std::optional<Vec3> cubeSideAt(const Ray& ray);

class ViewCube {
 public:
  // distance of the corner's camera; the cube fits in any orientation
  static constexpr double kDistance = 3.7;

  explicit ViewCube(vtkRenderer& corner); // it outlives this cube
  ~ViewCube();
  ViewCube(const ViewCube&) = delete;
  ViewCube& operator=(const ViewCube&) = delete;

  void setBackgroundStyle(const palette::BackgroundStyle& ground);
  void setHighlighted(const std::optional<Vec3>& side); // side: see cubeSideAt(); draws it brighter

 private:
  vtkRenderer& corner_;
  vtkSmartPointer<vtkAnnotatedCubeActor> cube_;
  vtkSmartPointer<vtkPolyData> patches_;
  vtkSmartPointer<vtkActor> highlight_;
};

} // namespace patina
