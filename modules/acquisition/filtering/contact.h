// Detects contact by the force; only then is the tip's path on the surface.
#pragma once

#include <vector>

#include "acquisition/values/scan_samples.h"

namespace patina {

// Contact begins above `on` and ends below `off`, each for at least `shortest`.
struct ContactLimits {
  double on = 0.1, off = 0.05; // [N]
  double shortest = 0.01;      // [s]
};

// Contact interval: samples from `begin` up to, not including, `end`.
struct ContactInterval {
  std::size_t begin, end;
};

// Sets `touching` of each sample, in the order of time. Throws std::invalid_argument if off > on.
void markContact(std::vector<PathSample>& path, const ContactLimits& limits = {});

// Returns the contact intervals. An interval ends when the probe is lifted or where samples are
// farther apart than `longest_pause` [s].
std::vector<ContactInterval> contactIntervals(const std::vector<PathSample>& path,
                                              double longest_pause = 0.05);

} // namespace patina
