// The look into a table of cells, compiled once for every instruction set: a source defines
// PATINA_KERNEL (a name of its own) and includes this. It must use no inline function of another
// header that is not always inlined, else the linker could keep the wrong copy for the whole
// program.
#pragma once

#include "field/sampling/four.h"
#include "scene/fourier/exact_phase.h"
#include "scene/fourier/plane_value.h"

namespace patina::PATINA_KERNEL {

using Eight = float __attribute__((vector_size(32)));

// Powers along x are summed as two polynomials of half the degree, side by side; eight along y in
// the lanes.
PlaneValue lookInto(const ExactRing& ring, const void* cells, double x, double y) noexcept {
  const RingPlace column = ring.at(x), row = ring.at(y);
  const float t = static_cast<float>(2 * column.beyond - 1);
  const float u = static_cast<float>(2 * row.beyond - 1);
  const Eight* c = static_cast<const Eight*>(cells) + 8 * (row.step * ring.steps() + column.step);
  Eight slope = c[3], value = slope * t + c[2], high_slope = c[7], high = high_slope * t + c[6];
  slope = slope * t + value;
  value = value * t + c[1];
  high_slope = high_slope * t + high;
  high = high * t + c[5];
  slope = slope * t + value;
  value = value * t + c[0];
  high_slope = high_slope * t + high;
  high = high * t + c[4];
  const float square = t * t, fourth = square * square;
  value += fourth * high;
  slope += (4 * t * square) * high + fourth * high_slope;

  const float square_y = u * u;
  const Float4 low = Float4{1, u, 1, u} * Float4{1, 1, square_y, square_y};
  const Float4 upper = low * (square_y * square_y);
  const Float4 slopes = Float4{0, 1, 2, 3} * __builtin_shufflevector(low, low, 0, 0, 1, 2);
  const Float4 upper_slopes = Float4{4, 5, 6, 7} * __builtin_shufflevector(low, upper, 3, 4, 5, 6);
  const Float4 value_low = __builtin_shufflevector(value, value, 0, 1, 2, 3);
  const Float4 value_upper = __builtin_shufflevector(value, value, 4, 5, 6, 7);
  const Float4 slope_low = __builtin_shufflevector(slope, slope, 0, 1, 2, 3);
  const Float4 slope_upper = __builtin_shufflevector(slope, slope, 4, 5, 6, 7);
  const Float4 sum = value_low * low + value_upper * upper;
  const Float4 along_x = slope_low * low + slope_upper * upper;
  const Float4 along_y = value_low * slopes + value_upper * upper_slopes;
  const Float4 both = __builtin_shufflevector(sum, along_x, 0, 4, 1, 5) +
                      __builtin_shufflevector(sum, along_x, 2, 6, 3, 7);
  const Float4 rest = along_y + __builtin_shufflevector(along_y, along_y, 2, 3, 2, 3);
  const double halves = ring.stepsATurn() * (2 / kTurn); // a cell's, a radian
  return {both[0] + both[2], (both[1] + both[3]) * halves, (rest[0] + rest[1]) * halves};
}

} // namespace patina::PATINA_KERNEL
