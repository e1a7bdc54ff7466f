// How a path goes about each of its samples, by parabolas in time: what a clock that is off needs.
#pragma once

#include <vector>

#include "acquisition/scan_samples.h"

namespace patina {

struct Course {
  Vec3 speed = Vec3::Zero(), bend = Vec3::Zero(); // of the place [m/s, m/s^2]
  Vec3 spin = Vec3::Zero();                       // [rad/s], in the path's frame
  double force = 0, rise = 0, curve = 0;          // of the force [N, N/s, N/s^2]
  double blur = 0; // of a slope, squared, where what it is taken of deviates by 1 [1/s^2]
  std::size_t begin = 0, end = 0; // the stretch without a pause that it lies in
};

// One a sample, each through some forty of them about it.
std::vector<Course> coursesOf(const std::vector<PathSample>& path);

// The force so much before a sample, smooth in `earlier` [s]; at the ends of its stretch it stays.
struct SmoothForce {
  double force = 0, rise = 0; // [N, N/s]
};
SmoothForce forceBefore(const std::vector<PathSample>& path, const std::vector<Course>& courses,
                        std::size_t sample, double earlier);

} // namespace patina
