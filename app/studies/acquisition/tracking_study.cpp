#include "app/studies/acquisition/tracking_study.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "acquisition/calibration/pivot.h"
#include "acquisition/simulation/simulated_frames.h"
#include "acquisition/simulation/simulated_pivot.h"
#include "acquisition/tracking/lens.h"
#include "acquisition/tracking/rig_pose.h"
#include "acquisition/vision/vision.h"
#include "acquisition/vision_library.h"
#include "app/studies/query_timing.h"
#include "core/decompose.h"
#include "core/error.h"

namespace patina {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

const Vec3 kTip(0, 0, -0.12);
constexpr double kEdge = 0.04; // of the cube [m]

struct Setting {
  std::string family = "apriltag_36h11";
  bool large = false;    // 1080p in place of 640 x 480
  double distance = 0.4; // [m]
  FrameLook look;
  std::optional<VisionRefinement> opencv = {}; // in place of ours
};

// As ours would hand them on, each as exact as any other.
std::vector<SeenMarker> foundByOpenCv(const GreyFrame& image, const Setting& setting,
                                      const Camera& camera) {
  std::vector<VisionMarker> found;
  if (const std::string cause =
          visionLibrary().markers(image, setting.family, *setting.opencv, found);
      !cause.empty())
    throw Error(cause);
  std::vector<SeenMarker> seen;
  for (const VisionMarker& one : found) {
    if (one.id > 4) continue; // not on the cube
    seen.push_back({setting.family, one.id, 0, {}, 0});
    for (std::size_t i = 0; i < 4; ++i)
      seen.back().corner[i] = {one.corner[i], straightened(camera, one.corner[i]).value(),
                               10 * Eigen::Matrix2d::Identity()};
  }
  return seen;
}

Camera cameraOf(const Setting& setting) {
  const std::array<double, 14> lens{-0.08, 0.03, 3e-4, -2e-4, 0};
  return setting.large ? Camera{1920, 1080, 1500, 1500, 955, 545, lens}
                       : Camera{640, 480, 600, 602, 322, 238, lens};
}

// The cube's top looks at the camera, leaning by up to 35 degrees.
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
  const std::vector<RigMarker> rig = markerCube(setting.family, family.side, kEdge);
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
    for (int pass = 0; pass < (setting.opencv ? 1 : 3); ++pass) {
      const double begin = threadSeconds();
      markers = setting.opencv ? foundByOpenCv(image, setting, camera)
                               : findMarkers(image, books, &camera);
      seen = poseOf(markers, rig, camera, nullptr, setting.opencv ? nullptr : &image);
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
    row.knobs = {{variation.knob, variation.value}};
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

// Beside OpenCV's own search with each of its refinements, of which the last is AprilTag 2.
std::vector<Variation> searches() {
  constexpr std::array<std::pair<const char*, VisionRefinement>, 4> kRefinements{
      {{"OpenCV", VisionRefinement::none},
       {"OpenCV subpix", VisionRefinement::subpix},
       {"OpenCV contour", VisionRefinement::contour},
       {"OpenCV apriltag", VisionRefinement::apriltag}}};
  std::vector<Variation> all;
  for (const bool large : {false, true}) {
    Setting setting;
    setting.large = large;
    const std::string picture = large ? " 1080p" : " 640x480";
    all.push_back({"search, picture", "ours" + picture, setting});
    for (const auto& [name, refinement] : kRefinements) {
      setting.opencv = refinement;
      all.push_back({"search, picture", name + picture, setting});
    }
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

// Median over seeds, as outliers of the fit would be seen in the largest.
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
    row.knobs = {{"outliers", outliers}};
    row.error = errors[errors.size() / 2];
    row.error_max = errors.back();
    row.ns = 1e9 * seconds / seeds;
    row.more = {{"nees", stated}};
    table.rows.push_back(row);
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
       {0.3, "searches", part("Beside OpenCV's search", searches())},
       {0.5, "distances",
        part("Distance [m]", varied("distance [m]", {0.25, 0.4, 0.6, 0.9}, distance))},
       {0.6, "blur", part("Blur [px]", varied("blur [px]", {0.4, 0.8, 1.2, 1.8, 2.5}, blur))},
       {0.8, "noise", part("Noise [grey levels]", varied("noise", {0, 2, 5, 10, 20}, noise))},
       {0.95, "tips", [&] { return tips(options); }}},
      progress);
}

} // namespace patina
