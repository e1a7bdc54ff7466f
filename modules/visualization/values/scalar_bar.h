// Scalar bar at the right edge of a picture.
#pragma once

#include <array>
#include <string>

#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>

#include "visualization/values/text_style.h"

namespace patina {

vtkSmartPointer<vtkScalarBarActor> scalarBar(const std::string& title);
void setTitle(vtkScalarBarActor& bar, const std::string& title);
// Fraction of the picture's width that fits its title.
double scalarBarShare(int wide, const TextStyle& letters);
// `size` is the picture's [pixels]. place = 0 at the right edge, 1 the next one to its left.
void placeScalarBar(vtkScalarBarActor& bar, int place, const TextStyle& letters,
                    const std::array<int, 2>& size);

} // namespace patina
