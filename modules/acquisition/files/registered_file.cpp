#include "acquisition/files/registered_file.h"

#include <cmath>
#include <map>
#include <optional>

#include "acquisition/files/measured.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina {

void writeRegisteredPath(const std::filesystem::path& path, const std::vector<PathSample>& samples,
                         const Registration& registration) {
  writeFileAtomically(path, registeredText(samples, registration));
}

std::string registeredText(const std::vector<PathSample>& samples,
                           const Registration& registration) {
  std::string text =
      csvHeader({"t [s]", "x [m]", "y [m]", "z [m]", "qx", "qy", "qz", "qw", "sigma [m]",
                 "force [N]", "face", "b0", "b1", "b2", "distance [m]"});
  const Pose& mesh_from_path = registration.mesh_from_path;
  const Eigen::Quaterniond turn(mesh_from_path.linear());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!registration.counts[i]) continue;
    const Vec3 p = mesh_from_path * samples[i].position;
    const Eigen::Quaterniond q = turn * samples[i].orientation;
    const Miss& miss = registration.misses[i];
    const Vec3& b = miss.foot.barycentric;
    text += csvRow({samples[i].t, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(), samples[i].sigma,
                    samples[i].force, static_cast<double>(miss.foot.face), b[0], b[1], b[2],
                    miss.distance});
  }
  return text;
}

namespace {

struct Place {
  double along = 0;
  double stretch = 0;
};

// By time.
std::map<double, Place> readPlaces(const std::filesystem::path& heights,
                                   std::vector<std::string>* warnings) {
  const CsvColumns columns = {
      {"t [s]", "along [m]", "height [m]", "sigma [m]", "stretch"}, {}, {"speed [m/s]"}};
  CsvReader reader(heights, columns);
  warnOfColumns(reader, warnings);
  std::map<double, Place> places;
  for (std::vector<double> row; reader.next(row);) {
    for (std::size_t i = 0; i < row.size(); ++i)
      requireMeasured(row[i], reader.columns()[i], heights.string(), reader.line());
    if (!places.empty() && !(row[0] > places.rbegin()->first))
      throw FileError(heights.string(), reader.line(), "time does not increase");
    places[row[0]] = {row[1], row[4]};
  }
  return places;
}

} // namespace

std::vector<PathOnMesh> readStrokes(const std::filesystem::path& path,
                                    const std::filesystem::path& heights,
                                    std::vector<std::string>* warnings) {
  constexpr double kPause = 5; // times the median interval
  CsvReader reader(path, {{"x [m]", "y [m]", "z [m]"},
                          {"t [s]"},
                          {"qx", "qy", "qz", "qw", "sigma [m]", "force [N]", "face", "b0", "b1",
                           "b2", "distance [m]"}});
  warnOfColumns(reader, warnings);
  const bool timed = reader.has("t [s]");
  const std::map<double, Place> places =
      heights.empty() ? std::map<double, Place>() : readPlaces(heights, warnings);
  if (!heights.empty() && places.empty()) throw FileError(heights.string(), 0, "has no height");
  if (!heights.empty() && !timed)
    throw FileError(path.string(), 1, "has no times to find the heights' by");
  std::vector<Vec3> points;
  std::vector<double> times, intervals;
  for (std::vector<double> row; reader.next(row);) {
    for (std::size_t i = 0; i < (timed ? row.size() : 3); ++i)
      requireMeasured(row[i], reader.columns()[i], path.string(), reader.line());
    if (timed) {
      if (!times.empty() && !(row[3] > times.back()))
        throw FileError(path.string(), reader.line(), "time does not increase");
      if (!times.empty()) intervals.push_back(row[3] - times.back());
      times.push_back(row[3]);
    }
    points.emplace_back(row[0], row[1], row[2]);
  }
  if (points.empty()) throw FileError(path.string(), 0, "has no point");
  const double pause = intervals.empty() ? 0 : kPause * percentiles(intervals).p50;
  std::vector<PathOnMesh> strokes(1);
  std::optional<Place> last;
  double last_time = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::optional<Place> place;
    if (!places.empty()) {
      const auto found = places.find(times[i]);
      if (found == places.end()) continue;
      place = found->second;
    }
    const bool other = place && last && place->stretch != last->stretch;
    if (!strokes.back().points.empty() && timed && (other || times[i] - last_time > pause))
      strokes.emplace_back();
    // Where the probe stood there is no way.
    const bool goes_on = place && !strokes.back().along.empty();
    const bool stood = goes_on && place->along == strokes.back().along.back();
    if (goes_on && !(place->along >= strokes.back().along.back()))
      throw FileError(heights.string(), 0,
                      "the way falls at " + formatNumber(times[i]) + " s, within one stretch");
    last = place;
    if (timed) last_time = times[i];
    if (stood) continue;
    strokes.back().points.push_back(points[i]);
    if (place) strokes.back().along.push_back(place->along);
  }
  if (strokes.back().points.empty())
    throw FileError(heights.string(), 0, "has no height at a time of " + path.string());
  return strokes;
}

} // namespace patina
