// What J of the closest point is worked out by, in voxels and single precision.
#pragma once

#include <cstddef>

#include "field/sampling/four.h"

namespace patina {

// Of a cell's eight nodes {phi, gx, gy, gz}: how far the next one along y and along z is.
inline constexpr std::size_t kNodeRow = 9, kNodeLayer = 81;

inline constexpr float kMostStretch = 4; // of J, along any direction

// Columns {0, x, y, z} of J by what SurfaceJacobian is made of. node: the lowest of the cell's; x,
// y, z: of the way along each axis. False where a stretch might be none or more than kMostStretch:
// then those of H across n.
using JacobianOfCell = bool (*)(const Float4* node, float x, float y, float z, const double* n,
                                double depth, double iso, Float4* columns) noexcept;

} // namespace patina
