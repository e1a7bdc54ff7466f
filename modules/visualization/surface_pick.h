// The surface under the mouse, found in the field: no depth buffer, no mesh.
#pragma once

#include <optional>

#include "field/surface_field.h"

namespace patina {

// First point of the ray where phi falls to 0, to a hundredth of a voxel. direction is unit.
// nullopt if the ray misses. Needs no sample layer.
std::optional<Vec3> firstSurfaceAlong(const SurfaceField& field, const Vec3& origin,
                                      const Vec3& direction);

} // namespace patina
