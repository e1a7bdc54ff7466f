// The strokes of a path over a mesh: what was drawn over it in one go.
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

// How far along its stretch of contact a sample lies.
struct StretchPlace {
  double along = 0; // [m]
  std::size_t stretch = 0;
};
using StretchPlaces = std::map<double, StretchPlace>; // by time [s]
StretchPlaces placesOf(const std::vector<ScanHeight>& heights);

// One wherever the time between two points is more than five times the median. Where `places` are
// known, one a stretch: points at other times are left out, as are those at which the probe stood,
// each stroke says how far along its points lie, and the longest comes first. Points in the order
// of time, one or more. Throws Error where the way falls within one stretch, or no point is at a
// time of `places`.
std::vector<PathOnMesh> strokesOf(const std::vector<TimedPoint>& points,
                                  const StretchPlaces& places);

} // namespace patina
