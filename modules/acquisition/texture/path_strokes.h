// Splits a path over a mesh into strokes.
#pragma once

#include <map>
#include <vector>

#include "acquisition/profile/scan_heights.h"
#include "acquisition/texture/texture_coordinates.h"

namespace patina {

struct TimedPoint {
  double t = 0;                 // [s]
  Vec3 position = Vec3::Zero(); // [m]
};

// Arc length of a sample within its contact interval.
struct IntervalPosition {
  double arc_length = 0; // [m]
  std::size_t stretch = 0;
};
using IntervalPositions = std::map<double, IntervalPosition>; // key: time [s]
IntervalPositions intervalPositions(const std::vector<ScanHeight>& heights);

// Starts a new stroke where the time between two points is more than five times the median. With
// `places` there is one stroke per contact interval: points at other times and those of a
// stationary probe are left out, strokes have the points' arc lengths, and the longest one comes
// first. At least one point, in the order of time. Throws Error if the arc length decreases within
// an interval, or no point has a time of `places`.
std::vector<PathOnMesh> strokesOf(const std::vector<TimedPoint>& points,
                                  const IntervalPositions& places);

} // namespace patina
