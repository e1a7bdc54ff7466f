// Lookup tables of colour scales (scene/color_scale.h).
#pragma once

#include <array>

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

#include "scene/color_scale.h"
#include "visualization/values/palette.h"

namespace patina {

// Colour of a map at t in 0 .. 1, not ColorMap::standard; of viridis, cividis (Nunez et al. 2018),
// magma and turbo (Mikhailov 2019) to 0.03 of their definitions.
palette::Color mapColor(ColorMap map, double t);

// Maps a thing has of its own: diverging is pale at 0 in any range, sequential is dark at the high
// end.
enum class StandardMap { diverging, sequential };

// Table over the range, in the range's unit.
vtkSmartPointer<vtkLookupTable> colorTable(const ColorScale& scale, StandardMap standard,
                                           const ValueRange& range);

// Format of a scale's numbers: the scale's digits, or `automatic`.
std::string labelFormat(const ColorScale& scale, const char* automatic);

} // namespace patina
