// What a registered path is off, told to the mesh that it was laid onto.
#pragma once

#include "acquisition/registration/register_path.h"

namespace patina {

// Samples speak for the mesh as far as this part of its extent.
inline constexpr double kErrorReach = 0.03;

// One a vertex [m]: the mean size of the misses that count and whose feet are within `reach` [m] of
// it on the same side of the mesh (normals at most 90 degrees apart), weighted by (1 -
// (d/reach)^2)^2 of their distance d; NaN where there is none. Throws std::invalid_argument unless
// reach > 0.
std::vector<float> errorMapOf(const TriangleMesh& mesh, const Registration& registration,
                              double reach);

} // namespace patina
