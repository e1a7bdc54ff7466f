// What J of the closest point is worked out by, in voxels and single precision.
#pragma once

#include <cstddef>

#include "field/sampling/four.h"

namespace patina {

// Of a cell's eight nodes {phi, gx, gy, gz}: how far the next one along y and along z is.
inline constexpr std::size_t kNodeRow = 9, kNodeLayer = 81;

inline constexpr float kMostStretch = 4; // of J, along any direction

// The columns {0, x, y, z} of SurfaceJacobian. node: the lowest of the cell's; x, y, z: how far
// along each axis the place is, 0 .. 1; the rest as of SurfaceJacobian's constructor.
using JacobianOfCell = void (*)(const Float4* node, float x, float y, float z, const double* n,
                                double depth, double iso, Float4* columns) noexcept;

} // namespace patina
