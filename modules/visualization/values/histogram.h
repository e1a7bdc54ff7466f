// Histograms of values.
#pragma once

#include <cstddef>
#include <vector>

namespace patina {

struct HistogramBin {
  double from = 0, to = 0;
  std::size_t count = 0;
};

// Bins of equal width from the smallest to the largest finite value; others are left out. Empty
// without a finite value; one bin if all are equal.
std::vector<HistogramBin> histogramOf(const std::vector<float>& values, std::size_t bins);

} // namespace patina
