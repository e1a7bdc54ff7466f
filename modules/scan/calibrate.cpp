#include "scan/calibrate.h"

#include <cmath>
#include <cstdio>

#include "acquisition/files/measured.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/json.h"
#include "core/numbers.h"
#include "geometry/io/pose_file.h"

namespace patina {
namespace {

constexpr double kMaxGain = 0.05;        // max deviation of an accelerometer's gain from 1
constexpr double kWorstCorners = 1.5;    // max reprojection error of a calibrated rig [px]
constexpr double kGravityNorm = 9.80665; // [m/s^2]

Json arrayOf(const Vec3& v) {
  return Json(Json::Array{v.x(), v.y(), v.z()});
}

// The rig to which a calibration is added. Without any its tip is that of a common probe.
Json jsonOf(const RigText& rig) {
  if (!rig.text.empty()) return parseJson(rig.text, rig.name);
  return Json::object().set("tip", arrayOf(ProbeModel().tip));
}

// Returns the rig's file with what was found; all else in it stays.
std::string withRig(const RigText& rig, const RigFit& fit) {
  Json json = parseJson(rig.text, rig.name);
  Json markers = Json::array();
  for (std::size_t i = 0; i < fit.markers.size(); ++i) {
    const FittedMarker& found = fit.markers[i];
    Json marker = json.at("markers").asArray()[i];
    marker.set("size", found.marker.size)
        .set("probe_from_marker", poseJson(found.marker.probe_from_marker));
    marker.set("size_deviation", found.size_deviation)
        .set("place_deviation", found.shift_deviation);
    markers.push(marker.set("angle_deviation", found.turn_deviation));
  }
  json.set("markers", markers);
  if (fit.tip)
    json.set("tip", arrayOf(fit.tip->place))
        .set("tip_deviation", arrayOf(fit.tip->covariance.diagonal().cwiseSqrt()));
  return json.dump() + "\n";
}

} // namespace

CameraCalibration calibrateCamera(const CameraCalibrationOptions& options, Progress& progress,
                                  const BoardSeen& seen) {
  const double rate = std::filesystem::is_directory(options.frames) ? 1 : 0;
  const auto frames = openFrames(options.frames, options.rate > 0 ? options.rate : rate);
  CameraCalibration report;
  static_cast<CalibratedCamera&>(report) =
      fitCameraToFrames(*frames, options.board, options.board_text, options.frames, progress, seen);
  if (report.doubt.empty()) report.file = calibratedText(report.fit, options.board_text);
  return report;
}

TipCalibration calibrateTip(const std::vector<CameraPose>& poses, const std::string& from,
                            const RigText& rig) {
  TipCalibration report{calibratePivot(poses, from), {}};
  report.file = withTip(rig.text.empty() ? "{}" : rig.text, rig.name, report.fit);
  return report;
}

RigCalibration calibrateRig(const RigCalibrationOptions& options, const RigText& rig,
                            Progress& progress) {
  const std::vector<RigMarker> markers = parseMarkers(rig.text, rig.name);
  const auto frames = openFrames(options.frames, options.rate);
  RigViews views;
  try {
    views = viewsOfRig(*frames, markers, options.camera, options.finder, options.frames, progress);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(rig.name, 0, error.what());
  }
  progress.report(0.9, "rig");
  RigCalibration report;
  report.frames = views.frames;
  report.warnings = views.notes;
  report.fit = fitRig(views.views, markers, views.camera, options.fit, options.frames);
  for (const FittedMarker& marker : report.fit.markers)
    if (!marker.finding.empty())
      report.warnings.push_back(rig.name + ": marker " + std::to_string(marker.marker.id) + " " +
                                marker.finding);
  for (const std::string& line : report.fit.held) report.warnings.push_back(line);
  if (report.fit.rms > kWorstCorners)
    report.doubt = options.frames + ": corners miss by " +
                   formatNumber(std::round(10 * report.fit.rms) / 10) +
                   " px, which is no calibration; look at the camera's calibration (its lens, its "
                   "size), at sizes and ids of the rig's markers, and whether the rig is rigid";
  else
    report.file = withRig(rig, report.fit);
  return report;
}

AxesCalibration calibrateAxes(const std::filesystem::path& folder, const RigText& rig,
                              std::vector<std::string>& warnings) {
  const std::filesystem::path stream = folder / "probe.csv";
  const std::vector<CameraPose> poses = readPoses(folder / "poses.tum").values;
  const std::vector<ProbeSample> samples = readProbeStream(stream, &warnings).values;
  Json json = jsonOf(rig);
  const ProbeModel probe = rig.text.empty() ? ProbeModel() : parseRig(rig.text, rig.name).probe;
  const auto fit = calibrateAccelerometers(poses, samples, probe);
  if (!fit)
    throw FileError(
        folder.string(), 0,
        "too few attitudes of the probe held still, or too similar ones: at least eight are "
        "needed, half a second each, in the air, leaning to all sides");
  Json axes = Json::object();
  for (std::size_t k = 0; k < kAxisNames.size(); ++k) {
    if (!(std::abs(fit->gain[k] - 1) < kMaxGain)) {
      char reads[400];
      std::snprintf(reads, sizeof reads, "%.2f", kGravityNorm * fit->gain[k]);
      throw FileError(stream.string(), 0,
                      std::string(kAxisNames[k]) + ": gravity reads " + reads +
                          " instead of 9.81: give accelerations in m/s^2");
    }
    Json axis = Json::object();
    axis.set("position", arrayOf(probe.axes[k].position));
    axes.set(kAxisNames[k], axis.set("direction", arrayOf(fit->directions[k])));
  }
  json.set("accelerometers", axes).set("gravity", arrayOf(fit->gravity));
  json.set("force_zero", fit->force_zero);
  return {*fit, probe, json.dump() + "\n"};
}

ForceCalibration calibrateForce(const std::filesystem::path& table, const RigText& rig,
                                std::vector<std::string>& warnings) {
  CsvReader reader(table, {{"force [N]", "reading"}});
  std::vector<KnownForce> readings;
  std::vector<std::size_t> lines;
  for (std::vector<double> row; reader.next(row);) {
    requireMeasured(row[0], "force [N]", table.string(), reader.line());
    requireMeasured(row[1], "reading", table.string(), reader.line());
    readings.push_back({row[0], row[1]});
    lines.push_back(reader.line());
  }
  warnOfColumns(reader, &warnings);
  if (!rig.text.empty()) (void)parseRig(rig.text, rig.name);
  Json json = jsonOf(rig);
  const auto fit = fitForce(readings);
  if (!fit)
    throw FileError(table.string(), 0,
                    "the readings do not determine zero and gain: at least four of three forces "
                    "are needed, and they must grow with the force");
  if (!fit->rejected.empty())
    warnings.push_back(table.string() + ":" + std::to_string(lines[fit->rejected[0]]) +
                       ": contradicts the other readings" +
                       (fit->rejected.size() > 1
                            ? ", as do " + formatCount(fit->rejected.size() - 1) + " more"
                            : ""));
  json.set("force_zero", fit->zero).set("force_gain", fit->gain);
  json.set("force_zero_deviation", fit->zero_deviation);
  json.set("force_gain_deviation", fit->gain_deviation);
  return {*fit, readings.size(), json.dump() + "\n"};
}

} // namespace patina
