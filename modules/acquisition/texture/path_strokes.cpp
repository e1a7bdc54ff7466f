#include "acquisition/texture/path_strokes.h"

#include <algorithm>

#include "core/error.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina {

IntervalPositions intervalPositions(const std::vector<ScanHeight>& heights) {
  IntervalPositions places;
  for (const ScanHeight& height : heights)
    places[height.t] = {height.point.arc_length, height.stretch};
  return places;
}

std::vector<PathOnMesh> strokesOf(const std::vector<TimedPoint>& points,
                                  const IntervalPositions& places) {
  constexpr double kPause = 5; // times the median interval
  std::vector<double> intervals;
  for (std::size_t i = 1; i < points.size(); ++i)
    intervals.push_back(points[i].t - points[i - 1].t);
  const double pause = intervals.empty() ? 0 : kPause * percentiles(intervals).p50;
  std::vector<PathOnMesh> strokes(1);
  const IntervalPosition* last = nullptr;
  double last_time = 0;
  for (const TimedPoint& point : points) {
    const auto found = places.find(point.t);
    if (!places.empty() && found == places.end()) continue;
    const IntervalPosition* place = places.empty() ? nullptr : &found->second;
    const bool other =
        place ? last && place->stretch != last->stretch : point.t - last_time > pause;
    if (!strokes.back().points.empty() && other) strokes.emplace_back();
    // The arc length is constant where the probe was stationary.
    const bool goes_on = place && !strokes.back().arc_length.empty();
    const bool stood = goes_on && place->arc_length == strokes.back().arc_length.back();
    if (goes_on && !(place->arc_length >= strokes.back().arc_length.back()))
      throw Error("arc length decreases at " + formatNumber(point.t) +
                  " s within one contact interval");
    last = place;
    last_time = point.t;
    if (stood) continue;
    strokes.back().points.push_back(point.position);
    if (place) strokes.back().arc_length.push_back(place->arc_length);
  }
  if (strokes.back().points.empty()) throw Error("has no height at a time of the path");
  // The first of overlapping strokes gets the faces.
  if (!places.empty())
    std::stable_sort(strokes.begin(), strokes.end(), [](const PathOnMesh& a, const PathOnMesh& b) {
      return a.arc_length.back() - a.arc_length.front() >
             b.arc_length.back() - b.arc_length.front();
    });
  return strokes;
}

} // namespace patina
