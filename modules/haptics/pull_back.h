// How something that lies on the surface changes as the tip moves: J^T of the closest point (K12).
#pragma once

#include "field/field_sampler.h"

namespace patina {

// `along`: the gradient at the closest point c(x) of a quantity on the surface; the result is that
// of the quantity read at c(x), by the tip: J^T along with J = I - n n^T - phi Hess phi. Lies in
// the plane across the unit normal n. q: the tip in grid coordinates; phi [voxel] there. The
// curvature is the difference of the sampler's directions a voxel apart: O(h^2) of itself, times
// phi over its radius. Beyond the band, and where it would more than double the gradient (near a
// medial axis), the surface counts as flat.
Vec3 pulledBack(const FieldSampler& sampler, const Vec3& q, const Vec3& n, double phi,
                const Vec3& along) noexcept;

} // namespace patina
