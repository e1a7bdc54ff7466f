// Surfaces of known height and the readings of a probe's tip on them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "acquisition/profile/height_profile.h"

namespace patina {

// Isotropic roughness of this rms [m]: waves of 0.8 to 6.4 mm, as high as they are long.
std::function<double(const Vec2&)> roughSurface(std::uint32_t seed, double rms);

// Milled profile, samples `step` apart [m]: arcs of the cutter, uneven feed, and waviness.
std::vector<double> milledProfile(std::uint32_t seed, double length, double step);

// Dilates heights `step` apart by a round tip, minus its radius; exact at the samples.
std::vector<double> envelope(const std::vector<double>& heights, double step, double radius);

// Readings of a probe stroked at constant speed over heights `step` apart: band-limited below half
// the rate, accelerations quantised. `offset` shifts the quantisation steps.
struct TraceReading {
  std::vector<TracedSample> samples;
  std::vector<double> heights; // true heights at the samples, without their best line [m]
};
TraceReading readTrace(const std::vector<double>& heights, double step, double speed, double rate,
                       double acceleration_step, double acceleration_noise, double offset,
                       std::uint32_t seed);

} // namespace patina
