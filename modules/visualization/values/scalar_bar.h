// The scalar bar at the right edge of a picture.
#pragma once

#include <array>
#include <string>

#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>

#include "visualization/values/lettering.h"

namespace patina {

vtkSmartPointer<vtkScalarBarActor> scalarBar(const std::string& title);
void setTitle(vtkScalarBarActor& bar, const std::string& title);
// How much of the picture's width one takes: its title fits.
double scalarBarShare(int wide, const Lettering& letters);
// In a picture of that size [pixels]. place = 0 at the right edge, 1 the next one to its left.
void placeScalarBar(vtkScalarBarActor& bar, int place, const Lettering& letters,
                    const std::array<int, 2>& size);

} // namespace patina
