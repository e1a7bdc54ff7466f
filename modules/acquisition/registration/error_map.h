// Error map of a registered path: mean residuals at the mesh's vertices.
#pragma once

#include "acquisition/registration/register_path.h"

namespace patina {

inline constexpr double kErrorRadius = 0.03; // kernel radius as a part of the mesh's extent

// Returns one value per vertex [m]: the mean absolute residual of the inliers whose closest points
// are within `reach` [m] on the same side of the mesh (normals at most 90 degrees apart), weighted
// by (1 - (d/reach)^2)^2 of their distance d; NaN without any. Throws std::invalid_argument unless
// reach > 0.
std::vector<float> errorMapOf(const TriangleMesh& mesh, const Registration& registration,
                              double reach);

} // namespace patina
