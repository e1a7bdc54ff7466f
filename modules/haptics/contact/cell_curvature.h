// What J of the closest point is worked out from, in voxels and single precision.
#pragma once

#include <array>
#include <cstddef>

#include "field/sampling/four.h"

namespace patina {

// Eight nodes {phi, gx, gy, gz}, so many apart; a point s between them, part of the way along each
// axis; n there, {0, x, y, z}, and tip = s + phi n.
struct CellCurvature {
  const Float4* node;
  std::size_t row, layer;
  std::array<float, 3> part;
  Float4 normal;
  float phi;
};

struct JacobianColumns { // {0, x, y, z} each
  std::array<Float4, 3> inverse;
  std::array<Float4, 3> both; // phi H
};

inline constexpr float kLeastStretch = 0.25F; // of 1 + phi times a curvature

// False where a stretch is less than that: inverse is of no use then.
using CellJacobian = bool (*)(const CellCurvature& cell, JacobianColumns& columns) noexcept;

} // namespace patina
