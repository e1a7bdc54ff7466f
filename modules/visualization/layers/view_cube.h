// A small cube in a corner that turns as the scene does, and whose sides, edges and corners say
// from where to look.
#pragma once

#include <optional>

#include <vtkActor.h>
#include <vtkAnnotatedCubeActor.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/types.h"
#include "visualization/values/lettering.h"
#include "visualization/view/camera.h"

namespace patina {

// Where a ray meets the cube of side 1 about the origin: from the middle towards the side, edge or
// corner that is there, each component -1, 0 or 1. Nullopt: it misses.
std::optional<Vec3> cubeSideAt(const Ray& ray);

class ViewCube {
 public:
  static constexpr double kDistance = 3.7; // of the corner's camera: it fits however it is turned

  explicit ViewCube(vtkRenderer& corner); // which outlives it
  ~ViewCube();
  ViewCube(const ViewCube&) = delete;
  ViewCube& operator=(const ViewCube&) = delete;

  void setGround(const palette::Ground& ground);
  void setHot(const std::optional<Vec3>& side); // is drawn brighter; of cubeSideAt()

 private:
  vtkRenderer& corner_;
  vtkSmartPointer<vtkAnnotatedCubeActor> cube_;
  vtkSmartPointer<vtkPolyData> patches_;
  vtkSmartPointer<vtkActor> hot_;
};

} // namespace patina
