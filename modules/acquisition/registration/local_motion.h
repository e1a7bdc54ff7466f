// Local motion of a path about its samples, by parabolas in time (Savitzky & Golay 1964).
#pragma once

#include <vector>

#include "acquisition/values/scan_samples.h"

namespace patina {

struct LocalMotion {
  Vec3 velocity = Vec3::Zero(), acceleration = Vec3::Zero(); // position [m/s, m/s^2]
  Vec3 angular_velocity = Vec3::Zero();                      // [rad/s], in the path's frame
  double force = 0, force_rate = 0, force_curvature = 0;     // force [N, N/s, N/s^2]
  double rate_variance = 0;       // variance of a slope for unit variance of the samples [1/s^2]
  std::size_t begin = 0, end = 0; // sample range of its segment without pauses
};

// Returns one per sample, each from about forty samples.
std::vector<LocalMotion> localMotions(const std::vector<PathSample>& path);

// Returns the smooth force `earlier` [s] before a sample; constant beyond its segment.
struct SmoothForce {
  double force = 0, force_rate = 0; // [N, N/s]
};
SmoothForce forceBefore(const std::vector<PathSample>& path,
                        const std::vector<LocalMotion>& motions, std::size_t sample,
                        double earlier);

} // namespace patina
