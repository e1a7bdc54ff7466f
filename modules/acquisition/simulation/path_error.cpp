#include "acquisition/simulation/path_error.h"

#include <algorithm>
#include <cmath>

namespace patina {

PathError errorOf(const std::vector<PathSample>& path, const std::vector<PathSample>& truth) {
  PathError error;
  for (const PathSample& sample : path) {
    const auto after =
        std::lower_bound(truth.begin(), truth.end(), sample.t,
                         [](const PathSample& known, double t) { return known.t < t; });
    if (after == truth.end() || (after == truth.begin() && after->t > sample.t)) continue;
    Vec3 place = after->position;
    if (after->t > sample.t) {
      const PathSample& before = *(after - 1);
      place += (before.position - place) * (after->t - sample.t) / (after->t - before.t);
    }
    const double square = (sample.position - place).squaredNorm();
    error.rms += square;
    error.most = std::max(error.most, std::sqrt(square));
    error.nees += square / (3 * sample.sigma * sample.sigma);
    ++error.samples;
  }
  if (error.samples > 0) {
    error.rms = std::sqrt(error.rms / static_cast<double>(error.samples));
    error.nees /= static_cast<double>(error.samples);
  }
  return error;
}

} // namespace patina
