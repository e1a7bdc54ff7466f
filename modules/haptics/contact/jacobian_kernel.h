// J of the closest point from a cell's nodes, compiled once for every instruction set: a source
// defines PATINA_KERNEL (a name of its own) and includes this. It must use no inline function of
// another header, else the linker could keep the wrong copy for the whole program.
#pragma once

#include "haptics/contact/cell_curvature.h"

namespace patina::PATINA_KERNEL {

[[gnu::always_inline]] inline float sumOf(Float4 value) noexcept {
  const Float4 halves = value + __builtin_shufflevector(value, value, 2, 3, 2, 3);
  return halves[0] + halves[1];
}

bool jacobianOf(const CellCurvature& cell, Float4* inverse, Float4* both) noexcept {
  const Float4* low = cell.node;
  const Float4* high = low + cell.layer;
  const float fx = cell.part[0], fy = cell.part[1], fz = cell.part[2], ex = 1 - fx, ey = 1 - fy;
  const Float4 n0 = low[0], n1 = low[1], n2 = low[cell.row], n3 = low[cell.row + 1];
  const Float4 z0 = high[0] - n0, z1 = high[1] - n1, z2 = high[cell.row] - n2,
               z3 = high[cell.row + 1] - n3;
  const Float4 m0 = n0 + fz * z0, m1 = n1 + fz * z1, m2 = n2 + fz * z2, m3 = n3 + fz * z3;
  // How {phi, gx, gy, gz} changes along each axis; phi's share is of no use.
  const Float4 a = ey * (m1 - m0) + fy * (m3 - m2), b = ex * (m2 - m0) + fx * (m3 - m1),
               c = ey * (ex * z0 + fx * z1) + fy * (ex * z2 + fx * z3), none = {0, 0, 0, 0};
  const Float4 a_low = __builtin_shufflevector(none, a, 0, 4, 1, 5),
               a_high = __builtin_shufflevector(none, a, 2, 6, 3, 7),
               b_low = __builtin_shufflevector(b, c, 0, 4, 1, 5),
               b_high = __builtin_shufflevector(b, c, 2, 6, 3, 7);
  // phi H.
  const float half = 0.5F * cell.phi;
  const Float4 halves = {0, half, half, half};
  const Float4 both_x = halves * (a + __builtin_shufflevector(a_low, b_low, 2, 3, 6, 7)),
               both_y = halves * (b + __builtin_shufflevector(a_high, b_high, 0, 1, 4, 5)),
               both_z = halves * (c + __builtin_shufflevector(a_high, b_high, 2, 3, 6, 7));
  const Float4 n = cell.normal, out = n[1] * both_x + n[2] * both_y + n[3] * both_z;
  const float out_out = sumOf(out * n);
  // In the plane the inverse of a matrix is its trace less itself, over its determinant.
  const float trace = (both_x[1] + both_y[2]) + (both_z[3] - out_out),
              squared =
                  sumOf(both_x * both_x + both_y * both_y + (both_z * both_z - 2 * out * out)) +
                  out_out * out_out,
              determinant = 1 + trace + 0.5F * (trace * trace - squared);
  const float k = 1 + trace, scale = 1 / determinant;
  const Float4 p = out - (out_out + k) * n;
  inverse[0] = scale * (Float4{0, k, 0, 0} - both_x + out[1] * n + n[1] * p);
  inverse[1] = scale * (Float4{0, 0, k, 0} - both_y + out[2] * n + n[2] * p);
  inverse[2] = scale * (Float4{0, 0, 0, k} - both_z + out[3] * n + n[3] * p);
  // Both eigenvalues.
  if (trace >= 2 * kLeastStretch - 2 &&
      determinant >= kLeastStretch * (2 + trace) - kLeastStretch * kLeastStretch) [[likely]]
    return true;
  both[0] = both_x;
  both[1] = both_y;
  both[2] = both_z;
  return false;
}

} // namespace patina::PATINA_KERNEL
