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

inline constexpr float kLeastStretch = 0.25F; // of 1 + phi times a curvature

// Three columns {0, x, y, z} of J into `inverse`. False where a stretch is less than kLeastStretch:
// then phi H's own into `both`, and inverse is of no use.
using CellJacobian = bool (*)(const CellCurvature& cell, Float4* inverse, Float4* both) noexcept;

} // namespace patina
