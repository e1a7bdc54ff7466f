#include "acquisition/texture/path_strokes.h"

#include <algorithm>

#include "core/error.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina {

StretchPlaces placesOf(const std::vector<ScanHeight>& heights) {
  StretchPlaces places;
  for (const ScanHeight& height : heights) places[height.t] = {height.point.along, height.stretch};
  return places;
}

std::vector<PathOnMesh> strokesOf(const std::vector<TimedPoint>& points,
                                  const StretchPlaces& places) {
  constexpr double kPause = 5; // times the median interval
  std::vector<double> intervals;
  for (std::size_t i = 1; i < points.size(); ++i)
    intervals.push_back(points[i].t - points[i - 1].t);
  const double pause = intervals.empty() ? 0 : kPause * percentiles(intervals).p50;
  std::vector<PathOnMesh> strokes(1);
  const StretchPlace* last = nullptr;
  double last_time = 0;
  for (const TimedPoint& point : points) {
    const auto found = places.find(point.t);
    if (!places.empty() && found == places.end()) continue;
    const StretchPlace* place = places.empty() ? nullptr : &found->second;
    const bool other =
        place ? last && place->stretch != last->stretch : point.t - last_time > pause;
    if (!strokes.back().points.empty() && other) strokes.emplace_back();
    // Where the probe stood there is no way.
    const bool goes_on = place && !strokes.back().along.empty();
    const bool stood = goes_on && place->along == strokes.back().along.back();
    if (goes_on && !(place->along >= strokes.back().along.back()))
      throw Error("the way falls at " + formatNumber(point.t) + " s, within one stretch");
    last = place;
    last_time = point.t;
    if (stood) continue;
    strokes.back().points.push_back(point.position);
    if (place) strokes.back().along.push_back(place->along);
  }
  if (strokes.back().points.empty()) throw Error("has no height at a time of the path");
  // Where two lie over one another the first gets the faces.
  if (!places.empty())
    std::stable_sort(strokes.begin(), strokes.end(), [](const PathOnMesh& a, const PathOnMesh& b) {
      return a.along.back() - a.along.front() > b.along.back() - b.along.front();
    });
  return strokes;
}

} // namespace patina
