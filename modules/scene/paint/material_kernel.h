// Kernel that evaluates painted material, compiled once per instruction set: a source defines
// PATINA_KERNEL (a unique name) and includes this. It must use no inline function of another
// header, or the linker might keep the wrong copy for the whole program.
#pragma once

#include "field/store/four.h"
#include "scene/paint/material_view.h"

namespace patina::PATINA_KERNEL {

using Two = double __attribute__((vector_size(16)));
using Mask4 = std::int64_t __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Double4 load(const double (&from)[4]) noexcept {
  return *reinterpret_cast<const Double4At*>(from);
}

// Returns true if the first three lanes are set.
[[gnu::always_inline]] inline bool holds(Mask4 mask) noexcept {
#if defined(__AVX2__)
  return (__builtin_ia32_movmskpd256((Double4)mask) & 7) == 7;
#else
  return (mask[0] & mask[1] & mask[2]) != 0;
#endif
}

// Loads the lower and the upper layer at a node and at the one above it along y.
[[gnu::always_inline]] inline Double4 fourAt(const double* low, std::int32_t up,
                                             std::int32_t above) noexcept {
  return Double4{low[0], low[above], low[up], low[up + above]};
}

void lookUp(const MaterialView& view, const double* p, double* material,
            double* const* gradients) noexcept {
  const Double4 q = p[0] * load(view.node_of_world[0]) + p[1] * load(view.node_of_world[1]) +
                    (p[2] * load(view.node_of_world[2]) + load(view.node_of_world[3]));
  if (!holds((q >= 0) & (q < load(view.count)))) return; // false for NaN too
  const Int4 whole = __builtin_convertvector(q, Int4);
  const Double4 part = q - __builtin_convertvector(whole, Double4);
  Int4 block_step, step;
  __builtin_memcpy(&block_step, view.block_step, sizeof block_step);
  __builtin_memcpy(&step, view.step, sizeof step);
  const Int4 cells = (whole >> 3) * block_step, nodes = (whole & 7) * step;
  // Computes both sums at once.
  const Int4 halves = __builtin_shufflevector(cells, nodes, 0, 4, 1, 5) +
                      __builtin_shufflevector(cells, nodes, 2, 6, 3, 7),
             sums = halves + __builtin_shufflevector(halves, halves, 2, 3, 2, 3);
  const std::int32_t slot = view.block_index[sums[0]];
  if (slot < 0) return;
  const double* low = view.nodes[slot] + sums[1];
  const std::int32_t right = step[0], up = step[1], above = step[2];
  const double fx = part[0], fy = part[1], fz = part[2];
  for (std::size_t c = 0; c < view.channels; ++c, ++low) {
    // a + f (b - a) is exact for equal ends, so that unpainted values remain the base.
    const Double4 left = fourAt(low, up, above), along_x = fourAt(low + right, up, above) - left,
                  at_x = left + fx * along_x;
    const Two front = __builtin_shufflevector(at_x, at_x, 0, 1),
              back = __builtin_shufflevector(at_x, at_x, 2, 3), along_y = back - front,
              ends = front + fy * along_y,
              x_front = __builtin_shufflevector(along_x, along_x, 0, 1),
              x_back = __builtin_shufflevector(along_x, along_x, 2, 3),
              x_ends = x_front + fy * (x_back - x_front);
    const Two lower = __builtin_shufflevector(ends, x_ends, 0, 2),
              upper = __builtin_shufflevector(ends, x_ends, 1, 3),
              of_both = lower + fz * (upper - lower);
    const MaterialView::Channel& channel = view.channel[c];
    material[channel.value] = of_both[0];
    if (channel.gradient < 0) continue;
    const double gx = of_both[1], gy = along_y[0] + fz * (along_y[1] - along_y[0]),
                 gz = ends[1] - ends[0];
    const Double4 at =
        gx * load(view.by_world[0]) + gy * load(view.by_world[1]) + gz * load(view.by_world[2]);
    // A block of three would go through the stack and integer registers.
    const Two xy = __builtin_shufflevector(at, at, 0, 1);
    __builtin_memcpy(gradients[channel.gradient], &xy, sizeof xy);
    gradients[channel.gradient][2] = at[2];
  }
}

} // namespace patina::PATINA_KERNEL
