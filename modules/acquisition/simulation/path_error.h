// How far a path is from the truth, where that is known.
#pragma once

#include "acquisition/scan_samples.h"

namespace patina {

struct PathError {
  double rms = 0, most = 0; // of the tip's distance [m]
  double nees = 0;          // squared errors over sigma squared, an axis: 1 where sigmas hold
  std::size_t samples = 0;  // that lie within the truth's times
};

// `truth` in the order of its time; between two samples it goes straight.
PathError errorOf(const std::vector<PathSample>& path, const std::vector<PathSample>& truth);

} // namespace patina
