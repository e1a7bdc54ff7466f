// The look into a line's cells, compiled once for every instruction set: a source defines
// PATINA_KERNEL (a name of its own) and includes this. It must use no inline function of another
// header that is not always inlined, else the linker could keep the wrong copy for the whole
// program.
#pragma once

#include "scene/fourier/series_polynomial.h"
#include "scene/fourier/series_value.h"

namespace patina::PATINA_KERNEL {

template <int kRows>
SeriesValue lookInto(const ExactRing& ring, const double* cells, double x) noexcept {
  const RingPlace place = ring.at(x);
  return polynomial<kRows>(cells + 4 * kRows * place.step, 2 * place.beyond - 1);
}

// By rows, 1 to 4; null beyond.
SeriesLook seriesLook(int rows) noexcept {
  switch (rows) {
  case 1:
    return &lookInto<1>;
  case 2:
    return &lookInto<2>;
  case 3:
    return &lookInto<3>;
  case 4:
    return &lookInto<4>;
  default:
    return nullptr;
  }
}

} // namespace patina::PATINA_KERNEL
