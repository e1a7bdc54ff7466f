// Kernel that evaluates a line's cells, compiled once per instruction set: a source defines
// PATINA_KERNEL (a unique name) and includes this. It must use only always inlined functions of
// other headers, or the linker might keep the wrong copy for the whole program.
#pragma once

#include "scene/fourier/series_polynomial.h"
#include "scene/fourier/series_value.h"

namespace patina::PATINA_KERNEL {

template <int kRows>
SeriesValue kernelFor(const PeriodicCells& ring, const double* cells, double x) noexcept {
  const CellPosition place = ring.at(x);
  return polynomial<kRows>(cells + 4 * kRows * place.step, 2 * place.fraction - 1);
}

// Returns the kernel for 1 to 4 rows, null for more.
SeriesKernel seriesKernel(int rows) noexcept {
  switch (rows) {
  case 1:
    return &kernelFor<1>;
  case 2:
    return &kernelFor<2>;
  case 3:
    return &kernelFor<3>;
  case 4:
    return &kernelFor<4>;
  default:
    return nullptr;
  }
}

} // namespace patina::PATINA_KERNEL
