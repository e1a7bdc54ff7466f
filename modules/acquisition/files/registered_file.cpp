#include "acquisition/files/registered_file.h"

#include <cmath>

#include "acquisition/files/measured.h"
#include "acquisition/texture/path_strokes.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json.h"
#include "geometry/io/pose_file.h"

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
    if (!registration.inliers[i]) continue;
    const Vec3 p = mesh_from_path * samples[i].position;
    const Eigen::Quaterniond q = turn * samples[i].orientation;
    const SurfaceResidual& residual = registration.residuals[i];
    const Vec3& b = residual.foot.barycentric;
    text += csvRow({samples[i].t, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(), samples[i].sigma,
                    samples[i].force, static_cast<double>(residual.foot.face), b[0], b[1], b[2],
                    residual.distance});
  }
  return text;
}

RegistrationReport readRegistrationReport(const std::filesystem::path& path) {
  RegistrationReport report{readPoseAt(path, "mesh_from_scan"), {}};
  try {
    const Json json = parseJson(readFile(path), path.string());
    if (const Json* compliance = json.find("compliance"))
      report.compliance = compliance->asNumber();
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(path.string(), 0, error.what());
  }
  return report;
}

namespace {

IntervalPositions readPlaces(const std::filesystem::path& heights,
                             std::vector<std::string>* warnings) {
  const CsvColumns columns = {
      {"t [s]", "along [m]", "height [m]", "sigma [m]", "stretch"}, {}, {"speed [m/s]"}};
  CsvReader reader(heights, columns);
  warnOfColumns(reader, warnings);
  IntervalPositions places;
  for (std::vector<double> row; reader.next(row);) {
    for (std::size_t i = 0; i < row.size(); ++i)
      requireMeasured(row[i], reader.columns()[i], heights.string(), reader.line());
    if (!places.empty() && !(row[0] > places.rbegin()->first))
      throw FileError(heights.string(), reader.line(), "time does not increase");
    places[row[0]] = {row[1], static_cast<std::size_t>(std::llround(row[4]))};
  }
  return places;
}

} // namespace

std::vector<PathOnMesh> readStrokes(const std::filesystem::path& path,
                                    const std::filesystem::path& heights,
                                    std::vector<std::string>* warnings) {
  CsvReader reader(path, {{"x [m]", "y [m]", "z [m]"},
                          {"t [s]"},
                          {"qx", "qy", "qz", "qw", "sigma [m]", "force [N]", "face", "b0", "b1",
                           "b2", "distance [m]"}});
  warnOfColumns(reader, warnings);
  const bool timed = reader.has("t [s]");
  const IntervalPositions places =
      heights.empty() ? IntervalPositions() : readPlaces(heights, warnings);
  if (!heights.empty() && places.empty()) throw FileError(heights.string(), 0, "has no height");
  if (!heights.empty() && !timed)
    throw FileError(path.string(), 1, "has no times to find the heights' by");
  std::vector<TimedPoint> points;
  for (std::vector<double> row; reader.next(row);) {
    for (std::size_t i = 0; i < (timed ? row.size() : 3); ++i)
      requireMeasured(row[i], reader.columns()[i], path.string(), reader.line());
    if (timed && !points.empty() && !(row[3] > points.back().t))
      throw FileError(path.string(), reader.line(), "time does not increase");
    points.push_back({timed ? row[3] : 0, Vec3(row[0], row[1], row[2])});
  }
  if (points.empty()) throw FileError(path.string(), 0, "has no point");
  try {
    return strokesOf(points, places);
  } catch (const Error& error) {
    throw FileError(heights.string(), 0, error.what());
  }
}

} // namespace patina
