// The scalar bar at the right edge of a picture.
#pragma once

#include <string>

#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>

namespace patina {

vtkSmartPointer<vtkScalarBarActor> scalarBar(const std::string& title);
// place = 0 at the edge, 1 the next one to its left.
void placeScalarBar(vtkScalarBarActor& bar, int place);
void setTextSize(vtkScalarBarActor& bar, int pixels);

} // namespace patina
