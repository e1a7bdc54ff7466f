#include "pipeline/spectrum_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace patina {
namespace {

double amplitude(const FourierSeries& series, std::size_t j) {
  return j < series.a.size() ? std::hypot(series.a[j], series.b[j]) : 0;
}

std::size_t strongestOf(const FourierSeries& series) {
  std::size_t most = 0;
  for (std::size_t j = 1; j < series.a.size(); ++j)
    if (amplitude(series, j) > amplitude(series, most)) most = j;
  return most;
}

struct Wave {
  double length, height;
};

// Through a window that is smooth at both ends, so that a wave need not fit the period whole: where
// between the strongest harmonic and its neighbours it is the highest.
Wave strongest(const FourierTexture& texture) {
  const std::size_t most = strongestOf(texture.series);
  const auto count = static_cast<int>(8 * texture.series.a.size());
  std::vector<double> windowed;
  double weights = 0;
  for (int i = 0; i < count; ++i) {
    const double part = (i + 0.5) / count, weight = 1 - std::cos(2 * std::numbers::pi * part);
    windowed.push_back(weight * height(texture, part * period(texture)));
    weights += weight;
  }
  const auto seenAt = [&](double harmonic) {
    double cosine = 0, sine = 0;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * harmonic * (i + 0.5) / count;
      cosine += windowed[static_cast<std::size_t>(i)] * std::cos(angle);
      sine += windowed[static_cast<std::size_t>(i)] * std::sin(angle);
    }
    return 2 * std::hypot(cosine, sine) / weights;
  };
  double best = static_cast<double>(most) + 1, highest = seenAt(best);
  for (double step = 0.5; step > 1e-4; step /= 2)
    for (const double tried : {best - step, best + step})
      if (const double seen = seenAt(tried); seen > highest) {
        highest = seen;
        best = tried;
      }
  return {period(texture) / best, highest};
}

} // namespace

SpectrumError spectrumError(const FourierTexture& texture, const FourierTexture& truth,
                            double floor) {
  if (texture.kind != TextureKind::line || truth.kind != TextureKind::line)
    throw std::invalid_argument("spectrumError: two lines");
  const Wave found = strongest(texture), real = strongest(truth);
  SpectrumError error{found.length, real.length, found.height, real.height, 0, 0};
  const std::size_t most = strongestOf(truth.series);
  for (std::size_t j = 0; j < truth.series.a.size(); ++j) {
    const double expected = amplitude(truth.series, j);
    const double wavelength = period(truth) / static_cast<double>(j + 1);
    if (!(expected > floor * wavelength * wavelength) && j != most) continue;
    ++error.compared;
    const double ratio = std::max(amplitude(texture.series, j), 1e-12) / expected;
    error.decibels = std::max(error.decibels, std::abs(20 * std::log10(ratio)));
  }
  return error;
}

} // namespace patina
