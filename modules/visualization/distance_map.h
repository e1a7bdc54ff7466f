// The diverging colour map of distance, shared by the slice and the nodes.
#pragma once

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

namespace patina {

// Perceptually even (Moreland's construction) from warm at -limit_mm through pale to cool at
// +limit_mm; 255 entries, so that zero has one of its own.
vtkSmartPointer<vtkLookupTable> distanceMap(double limit_mm);

} // namespace patina
