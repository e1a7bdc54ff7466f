// The diverging colours of signed quantities, shared by the slice, the nodes and the stability map.
#pragma once

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

namespace patina {

// Perceptually even (Moreland's construction) from warm at the low end through pale to cool at the
// high one; 255 entries, so that the middle has one of its own. The range is the caller's to set.
vtkSmartPointer<vtkLookupTable> divergingColors();
// From -limit_mm to +limit_mm.
vtkSmartPointer<vtkLookupTable> distanceMap(double limit_mm);

} // namespace patina
