// Points that may lie far from the origin.
#pragma once

#include <vtkPoints.h>
#include <vtkSmartPointer.h>

namespace patina {

// Returns an empty list in double precision. VTK itself moves points that lie far from the origin
// to about their middle before they become floats on the graphics card, and takes the way back into
// the camera's matrix. That helps only if they were not rounded to floats before.
inline vtkSmartPointer<vtkPoints> precisePoints() {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  return points;
}

} // namespace patina
