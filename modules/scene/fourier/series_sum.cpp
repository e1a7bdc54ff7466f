#include "scene/fourier/series_sum.h"

#include <array>
#include <cmath>

namespace patina {
namespace {

constexpr std::size_t kRotated = 8; // harmonics that advance together

} // namespace

SeriesValue sumDirectly(const FourierSeries& series, double phase) {
  SeriesValue sum{series.mean, 0};
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    const double j = static_cast<double>(i + 1), c = std::cos(j * phase), s = std::sin(j * phase);
    sum.value += series.a[i] * c + series.b[i] * s;
    sum.slope += j * (series.b[i] * c - series.a[i] * s);
  }
  return sum;
}

RotatedSeries::RotatedSeries(const FourierSeries& series)
    : mean_(series.mean), a_(series.a), b_(series.b) {
  const std::size_t whole = (a_.size() + kRotated - 1) / kRotated * kRotated;
  a_.resize(whole);
  b_.resize(whole);
}

SeriesValue RotatedSeries::at(double phase) const noexcept {
  std::array<double, kRotated> c{}, s{}, j{}, value{}, slope{};
  for (std::size_t k = 0; k < kRotated; ++k) {
    j[k] = static_cast<double>(k + 1);
    c[k] = std::cos(j[k] * phase);
    s[k] = std::sin(j[k] * phase);
  }
  const double turn_c = c[kRotated - 1], turn_s = s[kRotated - 1];
  for (std::size_t i = 0; i < a_.size(); i += kRotated) {
    for (std::size_t k = 0; k < kRotated; ++k) {
      const double a = a_[i + k], b = b_[i + k];
      value[k] += a * c[k] + b * s[k];
      slope[k] += j[k] * (b * c[k] - a * s[k]);
      const double next = c[k] * turn_c - s[k] * turn_s;
      s[k] = s[k] * turn_c + c[k] * turn_s;
      c[k] = next;
      j[k] += kRotated;
    }
  }
  SeriesValue sum{mean_, 0};
  for (std::size_t k = 0; k < kRotated; ++k) {
    sum.value += value[k];
    sum.slope += slope[k];
  }
  return sum;
}

void fillTerms(double phase, int harmonics, double* terms, double* slopes) {
  terms[0] = 1;
  slopes[0] = 0;
  for (int j = 1; j <= harmonics; ++j) {
    const double c = std::cos(j * phase), s = std::sin(j * phase);
    terms[2 * j - 1] = c;
    terms[2 * j] = s;
    slopes[2 * j - 1] = -j * s;
    slopes[2 * j] = j * c;
  }
}

} // namespace patina
