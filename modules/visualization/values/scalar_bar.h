// The scalar bar at the right edge of a picture.
#pragma once

#include <string>

#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>

namespace patina {

vtkSmartPointer<vtkScalarBarActor> scalarBar(const std::string& title);
// How much of the picture's width one takes: its title fits.
double scalarBarShare(int wide, int text_size);
// place = 0 at the edge, 1 the next one to its left; share as above.
void placeScalarBar(vtkScalarBarActor& bar, int place, double share);
void setTextSize(vtkScalarBarActor& bar, int pixels);

} // namespace patina
