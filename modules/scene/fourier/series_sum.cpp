#include "scene/fourier/series_sum.h"

#include <cmath>

namespace patina {

SeriesValue sumDirectly(const FourierSeries& series, double phase) {
  SeriesValue sum{series.mean, 0};
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    const double j = static_cast<double>(i + 1), c = std::cos(j * phase), s = std::sin(j * phase);
    sum.value += series.a[i] * c + series.b[i] * s;
    sum.slope += j * (series.b[i] * c - series.a[i] * s);
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
