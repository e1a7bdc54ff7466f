#include "app/studies/framework/studies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "acquisition/calibration/calibrate_rig.h"
#include "acquisition/calibration/pivot.h"
#include "acquisition/printing/printed_rig.h"
#include "acquisition/simulation/simulated_frames.h"
#include "acquisition/simulation/simulated_pivot.h"
#include "acquisition/simulation/simulated_rig.h"
#include "acquisition/tracking/lens.h"
#include "acquisition/tracking/marker_residual.h"
#include "acquisition/tracking/rig_pose.h"
#include "app/studies/framework/query_timing.h"
#include "core/decompose.h"

namespace patina {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

const Vec3 kTip(0, 0, -0.12);
constexpr double kEdge = 0.04; // edge of the cube [m]

struct Setting {
  std::string family = "apriltag_36h11";
  bool large = false;    // 1080p instead of 640 x 480
  double distance = 0.4; // [m]
  FrameLook look;
};

Camera cameraOf(const Setting& setting) {
  const std::array<double, 14> lens{-0.08, 0.03, 3e-4, -2e-4, 0};
  return setting.large ? Camera{1920, 1080, 1500, 1500, 955, 545, lens}
                       : Camera{640, 480, 600, 602, 322, 238, lens};
}

// The cube's top faces the camera, tilted by up to 35 degrees.
Pose somePose(std::mt19937& random, double distance) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double x = unit(random), y = unit(random), z = unit(random), a = unit(random),
               b = unit(random), c = unit(random);
  Pose pose = Pose::Identity();
  pose.translation() = distance * Vec3(0.1 * x, 0.07 * y, 1 + 0.05 * z);
  pose.linear() =
      (Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()) *
       Eigen::AngleAxisd(0.6 * a, Vec3::UnitX()) * Eigen::AngleAxisd(0.6 * b, Vec3::UnitY()) *
       Eigen::AngleAxisd(3 * c, Vec3::UnitZ()))
          .toRotationMatrix();
  return pose;
}

WorkPrecisionRow measured(const Setting& setting, int frames) {
  const Camera camera = cameraOf(setting);
  const MarkerFamily& family = markerFamily(setting.family);
  const std::vector<RigMarker> rig = printedRig({.size = kEdge, .family = setting.family}).markers;
  std::vector<PrintedMarker> printed;
  std::vector<int> ids;
  for (const RigMarker& marker : rig) {
    printed.push_back({marker, family.side, family.code[static_cast<std::size_t>(marker.id)]});
    ids.push_back(marker.id);
  }
  const std::vector<CodeBook> books{CodeBook(family, ids)};
  const FrameRenderer renderer(camera, printed);
  std::mt19937 random(1);
  double squares = 0, most = 0, nees = 0, corner = 0, corners = 0, seconds = 0, poses = 0;
  for (int i = 0; i < frames; ++i) {
    const Pose known = somePose(random, setting.distance);
    const GreyFrame image = renderer.render({known}, setting.look, static_cast<std::uint32_t>(i));
    double least = INFINITY;
    std::vector<SeenMarker> markers;
    SeenRig seen;
    for (int pass = 0; pass < 3; ++pass) {
      const double begin = threadSeconds();
      markers = findMarkers(image, books, &camera);
      seen = poseOf(markers, rig, camera, nullptr, &image);
      least = std::min(least, threadSeconds() - begin);
    }
    seconds += least;
    for (const SeenMarker& marker : markers)
      for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 place = rig[static_cast<std::size_t>(marker.id)].corners()[k];
        corner += (marker.corner[k].pixel - pixelOf(camera, known * place)).squaredNorm();
        corners += 1;
      }
    if (seen.verdict != RigVerdict::seen) continue;
    const double error = (seen.camera_from_probe * kTip - known * kTip).norm();
    squares += error * error;
    most = std::max(most, error);
    poses += 1;
    const Eigen::AngleAxisd turn(seen.camera_from_probe.linear() * known.linear().transpose());
    Vec6 off;
    off << seen.camera_from_probe.translation() - known.translation(), turn.angle() * turn.axis();
    nees += off.dot(SymmetricSolver(seen.covariance).solve(off)) / 6;
  }
  WorkPrecisionRow row;
  row.error = 1e3 * std::sqrt(squares / std::max(poses, 1.));
  row.error_max = 1e3 * most;
  row.ns = 1e9 * seconds / frames;
  row.more = {{"corners [px]", std::sqrt(corner / std::max(corners, 1.))},
              {"frames with a pose [%]", 100 * poses / frames},
              {"nees", nees / std::max(poses, 1.)}};
  return row;
}

struct Variation {
  std::string knob;
  Json value;
  Setting setting;
};

WorkPrecisionTable over(const std::string& title, const std::vector<Variation>& variations,
                        const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table =
      tableOf(title + " (A04): tip 120 mm from a marker cube, rms and max", "mm");
  for (const Variation& variation : variations) {
    progress.throwIfCancelled();
    const int frames = options.quick ? 3 : (options.thorough ? 200 : 20);
    WorkPrecisionRow row = measured(variation.setting, frames);
    row.settings = {{variation.knob, variation.value}};
    table.rows.push_back(row);
  }
  return table;
}

std::vector<Variation> cameras() {
  std::vector<Variation> all;
  for (const char* family : {"apriltag_36h11", "4x4_50", "6x6_250"})
    for (const bool large : {false, true}) {
      Setting setting;
      setting.family = family;
      setting.large = large;
      all.push_back(
          {"family, picture", std::string(family) + (large ? " 1080p" : " 640x480"), setting});
    }
  return all;
}

template <class Change>
std::vector<Variation> varied(const std::string& knob, const std::vector<double>& values,
                              const Change& change) {
  std::vector<Variation> all;
  for (const double value : values) {
    Setting setting;
    change(setting, value);
    all.push_back({knob, value, setting});
  }
  return all;
}

// The error is the median over seeds; the maximum beside it shows outliers of the fit.
WorkPrecisionTable tips(const StudyOptions& options) {
  WorkPrecisionTable table = tableOf(
      "Tip by turning about it (A05): 200 poses in a cone, 0.3 mm, 0.3 deg; median and max", "mm");
  const std::uint32_t seeds = options.quick ? 10 : (options.thorough ? 1000 : 100);
  for (const double outliers : {0., 0.1, 0.3}) {
    SimulatedPivot pivot;
    pivot.outliers = outliers;
    std::vector<double> errors;
    double seconds = 0, stated = 0;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
      const std::vector<CameraPose> poses = simulatePivot(pivot, seed);
      const double begin = threadSeconds();
      const auto fit = fitPivot(poses);
      seconds += threadSeconds() - begin;
      if (!fit) continue;
      const Vec3 off = fit->tip - pivot.tip;
      errors.push_back(1e3 * off.norm());
      stated += off.dot(SymmetricSolver(fit->covariance).solve(off)) / 3 / seeds;
    }
    if (errors.empty()) continue;
    std::sort(errors.begin(), errors.end());
    WorkPrecisionRow row;
    row.settings = {{"outliers", outliers}};
    row.error = errors[errors.size() / 2];
    row.error_max = errors.back();
    row.ns = 1e9 * seconds / seeds;
    row.more = {{"nees", stated}};
    table.rows.push_back(row);
  }
  return table;
}

// A rig that was made by hand and is calibrated from corners with errors of 0.04 px. The error is
// that of the tip beside a marker; "before" is that of the tip in the frames by the nominal rig.
struct RigTrial {
  double error = 0, before = 0; // [mm]
  double size = 0;              // largest error [%]
  double nees = 0, seconds = 0;
  bool found = false;
};

RigTrial calibrated(const HandmadeRig& made, double seconds, std::uint32_t seed) {
  constexpr double kRate = 15, kCorner = 0.04; // [Hz], [px]
  const Camera camera = cameraOf({});
  const std::vector<RigMarker> nominal = printedRig({.size = kEdge}).markers,
                               real = madeByHand(nominal, made, seed);
  WavedProbe probe;
  probe.seconds = seconds;
  probe.seed = seed;
  std::mt19937 random(seed);
  std::vector<RigView> views;
  RigTrial trial;
  double poses = 0;
  for (int i = 0; i < seconds * kRate; ++i) {
    const Pose known = wavedPose(probe, i / kRate);
    views.push_back({i / kRate, projectedMarkers(real, known, camera, kCorner, random)});
    const SeenRig seen = poseOf(views.back().markers, nominal, camera);
    if (seen.verdict != RigVerdict::seen) continue;
    trial.before += (seen.camera_from_probe * probe.tip - known * probe.tip).squaredNorm();
    poses += 1;
  }
  trial.before = 1e3 * std::sqrt(trial.before / std::max(1., poses));
  RigFitOptions options;
  options.measured = {{0, real[0].size}};
  options.calliper = 1e-6; // the size is exact
  const double begin = threadSeconds();
  const RigFit fit = fitRig(views, nominal, camera, options, "study");
  trial.seconds = threadSeconds() - begin;
  if (!fit.tip || fit.markers[0].views == 0) return trial;
  trial.found = true;
  const Pose &first = fit.markers[0].marker.probe_from_marker,
             align = first * real[0].probe_from_marker.inverse();
  const Vec3 off = fit.tip->place - align * probe.tip;
  trial.error = 1e3 * off.norm();
  for (std::size_t i = 0; i < real.size(); ++i)
    trial.size =
        std::max(trial.size, 100 * std::abs(fit.markers[i].marker.size / real[i].size - 1));
  // The tip beside the first marker: less the marker's shift and turn.
  MatX beside = MatX::Zero(3, fit.covariance.rows());
  beside.leftCols<3>() = -Eigen::Matrix3d::Identity();
  beside.middleCols<3>(3) = crossMatrix(fit.tip->place - first.translation());
  beside.rightCols<3>().setIdentity();
  const MatX covariance = beside * fit.covariance * beside.transpose();
  trial.nees = off.dot(SymmetricSolver(covariance).solve(off)) / 3;
  return trial;
}

WorkPrecisionRow trials(const HandmadeRig& made, double seconds, const StudyOptions& options,
                        Progress& progress) {
  const std::uint32_t seeds = options.quick ? 2 : (options.thorough ? 200 : 20);
  std::vector<double> errors;
  double before = 0, size = 0, nees = 0, spent = 0, found = 0;
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    progress.throwIfCancelled();
    const RigTrial trial = calibrated(made, seconds, seed);
    spent += trial.seconds;
    before += trial.before / seeds;
    if (!trial.found) continue;
    found += 1;
    errors.push_back(trial.error);
    size = std::max(size, trial.size);
    nees += trial.nees;
  }
  std::sort(errors.begin(), errors.end());
  WorkPrecisionRow row;
  if (!errors.empty()) {
    row.error = errors[errors.size() / 2];
    row.error_max = errors.back();
  }
  row.ns = 1e9 * spent / seeds;
  row.more = {{"before [mm]", before},
              {"sizes, max [%]", size},
              {"found [%]", 100 * found / seeds},
              {"nees", nees / std::max(found, 1.)}};
  return row;
}

WorkPrecisionTable rigs(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table = tableOf(
      "A rig made by hand (A31), calibrated from 60 s; tip beside a marker, median and max", "mm");
  constexpr double kDegree = std::numbers::pi / 180;
  const struct {
    const char* name;
    HandmadeRig made;
  } cases[] = {{"glue 0.1 mm 0.2 deg", {0.1e-3, 0.2 * kDegree, 1}},
               {"glue 0.3 mm 0.5 deg", {0.3e-3, 0.5 * kDegree, 1}},
               {"glue 1 mm 2 deg", {1e-3, 2 * kDegree, 1}},
               {"glue 0.3 mm 0.5 deg, print 0.99", {0.3e-3, 0.5 * kDegree, 0.99}},
               {"glue 0.3 mm 0.5 deg, print 1.01", {0.3e-3, 0.5 * kDegree, 1.01}},
               {"glue 0.3 mm 0.5 deg, print 1.03", {0.3e-3, 0.5 * kDegree, 1.03}}};
  for (const auto& each : cases) {
    table.rows.push_back(trials(each.made, 60, options, progress));
    table.rows.back().settings = {{"rig", each.name}, {"waved [s]", 60.}};
  }
  for (const double seconds : {10., 20., 40., 80.}) {
    table.rows.push_back(trials(cases[1].made, seconds, options, progress));
    table.rows.back().settings = {{"rig", cases[1].name}, {"waved [s]", seconds}};
  }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> trackingStudy(const StudyOptions& options, Progress& progress) {
  const auto part = [&](const std::string& title, const std::vector<Variation>& variations) {
    return [&, title, variations] { return over(title, variations, options, progress); };
  };
  const auto distance = [](Setting& setting, double value) { setting.distance = value; };
  const auto blur = [](Setting& setting, double value) { setting.look.blur = value; };
  const auto noise = [](Setting& setting, double value) { setting.look.noise = value; };
  return tablesOf(
      {{0, "cameras", part("Families and pictures", cameras())},
       {0.5, "distances",
        part("Distance [m]", varied("distance [m]", {0.25, 0.4, 0.6, 0.9}, distance))},
       {0.6, "blur", part("Blur [px]", varied("blur [px]", {0.4, 0.8, 1.2, 1.8, 2.5}, blur))},
       {0.8, "noise", part("Noise [grey levels]", varied("noise", {0, 2, 5, 10, 20}, noise))},
       {0.9, "tips", [&] { return tips(options); }},
       {0.92, "rigs", [&] { return rigs(options, progress); }}},
      progress);
}

} // namespace patina
