// Surfaces to scan whose heights are known, and what a probe's tip makes of them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "acquisition/profile/height_profile.h"

namespace patina {

// Isotropic roughness of this rms [m]: waves of 0.8 to 6.4 mm in all directions, high as they are
// long.
std::function<double(const Vec2&)> roughSurface(std::uint32_t seed, double rms);

// A profile as a milling cutter leaves it: arcs of the cutter side by side, with an uneven feed and
// waviness below; samples `step` apart [m].
std::vector<double> milledProfile(std::uint32_t seed, double length, double step);

// The envelope that the middle of a round tip follows over heights `step` apart (dilation), less
// the tip's radius. From whole samples: exact at them.
std::vector<double> envelope(const std::vector<double>& heights, double step, double radius);

// What a probe reads that is drawn over heights `step` apart at a steady speed: band-limited below
// half the rate, accelerations in steps of the sensor. `offset` shifts the steps.
struct TraceReading {
  std::vector<TracedSample> samples;
  std::vector<double> heights; // the truth at the samples, their best line taken off [m]
};
TraceReading readTrace(const std::vector<double>& heights, double step, double speed, double rate,
                       double acceleration_step, double acceleration_noise, double offset,
                       std::uint32_t seed);

} // namespace patina
