// When the probe touches, by its force: only then is its tip's path a path on the surface.
#pragma once

#include <vector>

#include "acquisition/scan_samples.h"

namespace patina {

// Contact begins above `on` and ends below `off`, each for `shortest` at least.
struct ContactLimits {
  double on = 0.1, off = 0.05; // [N]
  double shortest = 0.01;      // [s]
};

// From `begin` up to, not including, `end`.
struct Stretch {
  std::size_t begin, end;
};

// Sets `touching` of each sample, in the order of time. Throws std::invalid_argument if off > on.
void markContact(std::vector<PathSample>& path, const ContactLimits& limits = {});

// The stretches in which it touches, each whole: between two of them it was lifted, or samples are
// farther apart than `longest_pause` [s].
std::vector<Stretch> touchingStretches(const std::vector<PathSample>& path,
                                       double longest_pause = 0.05);

} // namespace patina
