// Error of a path against its known truth.
#pragma once

#include "acquisition/values/scan_samples.h"

namespace patina {

struct PathError {
  double rms = 0, most = 0; // distance of the tips [m]
  double nees = 0; // mean squared error per axis over sigma squared: 1 if the sigmas are right
  std::size_t samples = 0; // samples within the truth's times
};

// `truth` is in the order of time and interpolated linearly.
PathError errorOf(const std::vector<PathSample>& path, const std::vector<PathSample>& truth);

} // namespace patina
