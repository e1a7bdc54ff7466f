#include "visualization/values/histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patina {

std::vector<HistogramBin> histogramOf(const std::vector<float>& values, std::size_t bins) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min<double>(low, value);
    high = std::max<double>(high, value);
  }
  if (low > high) return {};
  std::vector<HistogramBin> histogram(low < high ? std::max<std::size_t>(1, bins) : 1);
  const double width = (high - low) / static_cast<double>(histogram.size());
  for (std::size_t i = 0; i < histogram.size(); ++i) {
    histogram[i].from = low + static_cast<double>(i) * width;
    histogram[i].to = i + 1 < histogram.size() ? histogram[i].from + width : high;
  }
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    const auto bin = width > 0 ? static_cast<std::size_t>((value - low) / width) : 0;
    ++histogram[std::min(bin, histogram.size() - 1)].count;
  }
  return histogram;
}

} // namespace patina
