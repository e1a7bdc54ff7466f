// Points in double precision, for scenes far from the origin.
#pragma once

#include <vtkPoints.h>
#include <vtkSmartPointer.h>

namespace patina {

// Returns an empty list in double precision. VTK shifts points that are far from the origin towards
// it before it converts them to floats for the graphics card, and undoes the shift in the camera's
// matrix. This requires points that were not rounded to floats before.
inline vtkSmartPointer<vtkPoints> precisePoints() {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  return points;
}

} // namespace patina
