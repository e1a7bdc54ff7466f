// Diverging colours of signed quantities, shared by slice, nodes and stability map.
#pragma once

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

namespace patina {

// Perceptually uniform diverging map (Moreland 2009) from warm at the low end through pale to cool
// at the high end; 255 entries, so that the middle has its own. The caller sets the range.
vtkSmartPointer<vtkLookupTable> divergingColors();
vtkSmartPointer<vtkLookupTable> distanceMap(double limit_mm);

} // namespace patina
