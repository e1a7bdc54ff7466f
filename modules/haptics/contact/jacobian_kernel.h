// Jacobian of the closest point from a cell's nodes, compiled for each instruction set: a source
// defines PATINA_KERNEL (a unique name) and includes this file. It must not use inline functions of
// other headers, or the linker could keep the wrong copy for the whole program.
#pragma once

#include <cstddef>

#include "field/store/four.h"

namespace patina::PATINA_KERNEL {

// Distances between a cell's nodes {phi, gx, gy, gz} along y and along z [Float4].
constexpr std::size_t kNodeRow = 9, kNodeLayer = 81;
constexpr float kMaxStretch = 4;     // largest singular value of J
constexpr float kMinSquare = 1e-16F; // smallest squared curvature difference

// Stores {0, x, y, z} as {x, y, z, 0}.
[[gnu::always_inline]] inline void storeColumn(Float4 column, double* to) noexcept {
  const Float4 turned = __builtin_shufflevector(column, column, 1, 2, 3, 0);
  *reinterpret_cast<Double4At*>(to) = __builtin_convertvector(turned, Double4);
}

[[gnu::always_inline]] inline float sumOf(Float4 value) noexcept {
  const Float4 halves = value + __builtin_shufflevector(value, value, 2, 3, 2, 3);
  return halves[0] + halves[1];
}

[[gnu::always_inline]] inline Float4 lanesOf(const double* v) noexcept {
  return Float4{0, static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

// Singular value of J for one principal curvature.
[[gnu::always_inline]] inline float stretchOf(float curvature, float depth, float iso) noexcept {
  const float part = 1 - iso * curvature, by = 1 - depth * curvature;
  if (!(part > 0)) return 0;
  return part < kMaxStretch * by ? part / by : kMaxStretch;
}

// Computes the columns of SurfaceJacobian, in voxels, in single precision. low: first node of the
// cell; fx, fy, fz: position in the cell, 0 .. 1; other arguments as for SurfaceJacobian.
void jacobianOf(const Float4* low, float fx, float fy, float fz, const double* normal, double depth,
                double iso, double* columns) noexcept {
  const Float4* high = low + kNodeLayer;
  const float ex = 1 - fx, ey = 1 - fy;
  const Float4 n0 = low[0], n1 = low[1], n2 = low[kNodeRow], n3 = low[kNodeRow + 1];
  const Float4 z0 = high[0] - n0, z1 = high[1] - n1, z2 = high[kNodeRow] - n2,
               z3 = high[kNodeRow + 1] - n3;
  const Float4 m0 = n0 + fz * z0, m1 = n1 + fz * z1, m2 = n2 + fz * z2, m3 = n3 + fz * z3;
  // Derivatives of {phi, gx, gy, gz} along each axis; the one of phi is unused.
  const Float4 a = ey * (m1 - m0) + fy * (m3 - m2), b = ex * (m2 - m0) + fx * (m3 - m1),
               c = ey * (ex * z0 + fx * z1) + fy * (ex * z2 + fx * z3), none = {0, 0, 0, 0};
  const Float4 a_low = __builtin_shufflevector(none, a, 0, 4, 1, 5),
               a_high = __builtin_shufflevector(none, a, 2, 6, 3, 7),
               b_low = __builtin_shufflevector(b, c, 0, 4, 1, 5),
               b_high = __builtin_shufflevector(b, c, 2, 6, 3, 7);
  // Symmetrised Hessian of phi.
  const Float4 halves = {0, 0.5F, 0.5F, 0.5F}, n = lanesOf(normal);
  const Float4 h_x = halves * (a + __builtin_shufflevector(a_low, b_low, 2, 3, 6, 7)),
               h_y = halves * (b + __builtin_shufflevector(a_high, b_high, 0, 1, 4, 5)),
               h_z = halves * (c + __builtin_shufflevector(a_high, b_high, 2, 3, 6, 7));
  const Float4 out = n[1] * h_x + n[2] * h_y + n[3] * h_z;
  const float along = sumOf(out * n), sum = (h_x[1] + h_y[2]) + (h_z[3] - along),
              squares = sumOf(h_x * h_x + h_y * h_y + (h_z * h_z - 2 * out * out)) + along * along;
  // Projects the Hessian onto the tangent plane.
  const Float4 rest = out - along * n, flat_x = h_x - out[1] * n - n[1] * rest,
               flat_y = h_y - out[2] * n - n[2] * rest, flat_z = h_z - out[3] * n - n[3] * rest;
  // J has the eigenvectors of H, so J = a P + b H.
  const auto d = static_cast<float>(depth), i = static_cast<float>(iso);
  const float span = (kMaxStretch * d - i) * (1.F / 3), spans = span * span, ds = d * d, is = i * i,
              most = ds > is ? ds : is;
  float of_plane, of_curvature;
  if (squares * (spans > most ? spans : most) < 1)
      [[likely]] { // no singular value reaches its limit
    const float product = 0.5F * (sum * sum - squares), less = 1 - d * sum,
                scale = 1 / (less + ds * product);
    of_plane = scale * (less + i * d * product);
    of_curvature = scale * (d - i);
  } else {
    const float mean = 0.5F * sum, square = 0.5F * squares - mean * mean,
                half = __builtin_sqrtf(square > kMinSquare ? square : kMinSquare),
                upper = stretchOf(mean + half, d, i), lower = stretchOf(mean - half, d, i);
    of_curvature = 0.5F * (upper - lower) / half;
    of_plane = 0.5F * (upper + lower) - of_curvature * mean;
  }
  const Float4 plane_n = of_plane * n;
  storeColumn(of_curvature * flat_x + (Float4{0, of_plane, 0, 0} - n[1] * plane_n), columns);
  storeColumn(of_curvature * flat_y + (Float4{0, 0, of_plane, 0} - n[2] * plane_n), columns + 4);
  storeColumn(of_curvature * flat_z + (Float4{0, 0, 0, of_plane} - n[3] * plane_n), columns + 8);
}

} // namespace patina::PATINA_KERNEL
