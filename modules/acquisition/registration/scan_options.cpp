#include "acquisition/registration/scan_options.h"

#include <algorithm>
#include <numbers>

#include "core/percentiles.h"

namespace patina {

RegistrationOptions defaultOptions(const std::vector<PathSample>& path) {
  constexpr double kPlaces = 1. / 200; // sample spacing over the path's radius
  RegistrationOptions options;
  std::vector<Vec3> points;
  std::vector<double> sigmas;
  for (const PathSample& sample : path) {
    points.push_back(sample.position);
    sigmas.push_back(sample.sigma);
    options.force.push_back(sample.force);
  }
  // The compliance is not observable without forces.
  if (std::all_of(options.force.begin(), options.force.end(), [](double f) { return f == 0; }))
    options.force.clear();
  options.noise = percentiles(sigmas).p50;
  options.sample_spacing = kPlaces * scaleOf(points, Pose::Identity()).radius;
  options.alternatives = true;
  return options;
}

CoarseSearch globalSearch(const SurfaceTarget& target) {
  return {std::numbers::pi, target.extent() / 2, 12, 8000};
}

} // namespace patina
