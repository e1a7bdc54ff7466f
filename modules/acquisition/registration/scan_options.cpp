#include "acquisition/registration/scan_options.h"

#include <algorithm>
#include <numbers>

#include "core/percentiles.h"

namespace patina {

RegistrationOptions optionsFor(const std::vector<PathSample>& path) {
  constexpr double kPlaces = 1. / 200; // of the path's radius: nearer samples are one place
  RegistrationOptions options;
  std::vector<Vec3> points;
  std::vector<double> sigmas;
  for (const PathSample& sample : path) {
    points.push_back(sample.position);
    sigmas.push_back(sample.sigma);
    options.force.push_back(sample.force);
  }
  // Without a force nothing is known of what yields.
  if (std::all_of(options.force.begin(), options.force.end(), [](double f) { return f == 0; }))
    options.force.clear();
  options.noise = percentiles(sigmas).p50;
  options.place = kPlaces * scaleOf(points, Pose::Identity()).radius;
  options.rivals = true;
  return options;
}

CoarseSearch anywhereOn(const SurfaceTarget& target) {
  return {std::numbers::pi, target.extent() / 2, 12, 8000};
}

} // namespace patina
