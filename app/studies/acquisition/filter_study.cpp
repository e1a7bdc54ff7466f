#include "app/studies/framework/studies.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/filtering/fused_path.h"
#include "acquisition/simulation/hand_gestures.h"
#include "acquisition/simulation/path_error.h"
#include "acquisition/simulation/simulated_streams.h"
#include "acquisition/simulation/simulated_surface.h"
#include "app/studies/acquisition/filter_tables.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kPi = std::numbers::pi;

struct Course {
  bool faults;
  double seconds;
};

struct Scan {
  SimulatedHand hand;
  ProbeModel probe;
  std::vector<CameraPose> poses;
  std::vector<ProbeSample> samples;
  std::vector<double> times;
  std::vector<PathSample> truth; // at the same times
};

Scan scanOf(std::uint32_t seed, const Course& course) {
  Scan scan;
  scan.hand = strokes(seed, course.seconds);
  scan.hand.relief = roughSurface(seed, 25e-6);
  SimulatedCamera camera;
  if (course.faults) {
    camera.outliers = 0.03;
    for (double begin = 3; begin < course.seconds; begin += 4.5)
      camera.gaps.push_back({begin, begin + 0.3});
  }
  scan.poses = simulateCamera(scan.hand, scan.probe, camera, seed);
  scan.samples = simulateProbe(scan.hand, scan.probe, {}, seed + 100);
  for (const ProbeSample& sample : scan.samples) scan.times.push_back(sample.t);
  scan.truth = truthAt(scan.hand, Pose::Identity(), scan.times);
  return scan;
}

// Zero-phase high-pass above `frequency`: a second-order Butterworth filter, forwards and
// backwards.
std::vector<double> above(std::vector<double> values, double frequency, double rate) {
  const double w = std::tan(kPi * frequency / rate), a = 1 / (1 + std::numbers::sqrt2 * w + w * w);
  const double b1 = 2 * a * (w * w - 1), b2 = a * (1 - std::numbers::sqrt2 * w + w * w);
  for (int way = 0; way < 2; ++way) {
    double x1 = values[0], x2 = values[0], y1 = 0, y2 = 0;
    for (double& value : values) {
      const double y = a * (value - 2 * x1 + x2) - b1 * y1 - b2 * y2;
      x2 = x1, x1 = value, y2 = y1, y1 = y;
      value = y;
    }
    std::reverse(values.begin(), values.end());
  }
  return values;
}

// Relative error of the height above 10 Hz in contact.
double textureError(const Scan& scan, const std::vector<PathSample>& path) {
  std::vector<double> heights, errors;
  for (std::size_t i = 0; i < path.size(); ++i) {
    heights.push_back(scan.truth[i].position.z());
    errors.push_back(path[i].position.z() - heights.back());
  }
  const std::vector<double> texture = above(heights, 10, 500), wrong = above(errors, 10, 500);
  double squares = 0, all = 0;
  for (std::size_t i = 0; i < texture.size(); ++i)
    if (scan.truth[i].touching) {
      squares += wrong[i] * wrong[i];
      all += texture[i] * texture[i];
    }
  return std::sqrt(squares / all);
}

// Error of the camera's tip at the times of its frames.
PathError rawError(const Scan& scan) {
  std::vector<PathSample> raw;
  std::vector<double> times;
  for (const CameraPose& pose : scan.poses) {
    PathSample sample;
    sample.t = pose.t;
    sample.position = pose.position + pose.orientation * scan.probe.tip;
    raw.push_back(sample);
    times.push_back(pose.t);
  }
  return errorOf(raw, truthAt(scan.hand, Pose::Identity(), times));
}

struct Method {
  const char* name;
  bool acceleration, smooth, fused;
};
constexpr Method kMethods[] = {{"velocity", false, false, false},
                               {"velocity, smoothed", false, true, false},
                               {"acceleration", true, false, false},
                               {"acceleration, smoothed", true, true, false},
                               {"camera and probe", true, true, true}};

std::vector<PathSample> pathBy(const Method& method, const Scan& scan) {
  if (method.fused) return fusePath(scan.poses, scan.samples, scan.probe).path;
  CameraTrackOptions options;
  options.acceleration = method.acceleration;
  options.smooth = method.smooth;
  return pathAt(trackTip(scan.poses, scan.probe.tip, options), scan.times);
}

WorkPrecisionTable paths(const Course& course, const StudyOptions& options, Progress& progress) {
  const bool lasting = course.seconds > 100;
  WorkPrecisionTable table =
      filterTable("Tip in " + formatNumber(course.seconds) + " s of strokes" +
                      (course.faults ? ", a gap of 0.3 s each 4.5 s and 3 % outliers" : "") +
                      " (A06), rms and max",
                  "mm");
  const std::uint32_t seeds = lasting ? 1 : options.quick ? 2 : options.thorough ? 60 : 6;
  std::vector<Scan> scans;
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) scans.push_back(scanOf(seed, course));
  double raw = 0, seconds = 0;
  WorkPrecisionRow camera;
  camera.settings = {{"filter", "raw camera"}};
  for (const Scan& scan : scans) {
    const PathError error = rawError(scan);
    raw += error.rms * error.rms / seeds;
    camera.error_max = std::max(camera.error_max, 1e3 * error.most);
    seconds += scan.hand.seconds();
  }
  raw = std::sqrt(raw);
  camera.error = 1e3 * raw;
  camera.more = {{"of raw", 1}, {"nees", 0}, {"texture above 10 Hz", 0}, {"of real time [%]", 0}};
  table.rows.push_back(camera);
  for (const Method& method : kMethods) {
    progress.throwIfCancelled();
    PathError sum;
    double taken = 0, texture = 0;
    for (const Scan& scan : scans) {
      double least = INFINITY;
      std::vector<PathSample> path;
      for (int pass = 0; pass < (lasting ? 1 : 3); ++pass) {
        const double begin = threadSeconds();
        path = pathBy(method, scan);
        least = std::min(least, threadSeconds() - begin);
      }
      taken += least;
      const PathError error = errorOf(path, scan.truth);
      sum.rms += error.rms * error.rms / seeds;
      sum.most = std::max(sum.most, error.most);
      sum.nees += error.nees / seeds;
      texture += textureError(scan, path) / seeds;
    }
    WorkPrecisionRow row;
    row.settings = {{"filter", method.name}};
    row.error = 1e3 * std::sqrt(sum.rms);
    row.error_max = 1e3 * sum.most;
    row.ns = 1e9 * taken / seconds;
    row.more = {{"of raw", std::sqrt(sum.rms) / raw},
                {"nees", sum.nees},
                {"texture above 10 Hz", texture},
                {"of real time [%]", 100 * taken / seconds}};
    table.rows.push_back(row);
  }
  return table;
}

// Hands beside strokes: the fused path with accelerometers, and its error with a gyroscope too.
WorkPrecisionTable hands(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table =
      filterTable("Tip of hands that move freely for 10 s (A06), rms and max", "mm");
  const std::uint32_t seeds = options.thorough ? 10 : 1;
  for (const HandGesture kind : kHandGestures) {
    progress.throwIfCancelled();
    WorkPrecisionRow row;
    row.settings = {{"hand", nameOf(kind)}};
    double squares = 0, nees = 0, velocity = 0, turned = 0, taken = 0;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
      Scan scan;
      scan.hand = gesture(kind, seed);
      SimulatedCamera camera;
      camera.sigma_angle = 3e-3;
      scan.poses = simulateCamera(scan.hand, scan.probe, camera, seed);
      scan.samples = simulateProbe(scan.hand, scan.probe, {}, seed + 100);
      for (const ProbeSample& sample : scan.samples) scan.times.push_back(sample.t);
      scan.truth = truthAt(scan.hand, Pose::Identity(), scan.times);
      const double begin = threadSeconds();
      const PathError fused = errorOf(pathBy(kMethods[4], scan), scan.truth);
      taken += (threadSeconds() - begin) / scan.hand.seconds() / seeds;
      const PathError simple = errorOf(pathBy(kMethods[1], scan), scan.truth);
      const PathError full = errorOf(fusePath(scan.poses, scan.samples, scan.probe, {},
                                              simulateRates(scan.hand, scan.probe, {}, seed + 200))
                                         .path,
                                     scan.truth);
      squares += fused.rms * fused.rms / seeds;
      nees += fused.nees / seeds;
      velocity += simple.rms * simple.rms / seeds;
      turned += full.rms * full.rms / seeds;
      row.error_max = std::max(row.error_max, 1e3 * fused.most);
    }
    row.error = 1e3 * std::sqrt(squares);
    row.ns = 1e9 * taken;
    row.more = {{"velocity", 1e3 * std::sqrt(velocity)},
                {"with gyroscope", 1e3 * std::sqrt(turned)},
                {"nees", nees},
                {"of real time [%]", 100 * taken}};
    table.rows.push_back(row);
  }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> filterStudy(const StudyOptions& options, Progress& progress) {
  const auto course = [&](bool faults, double seconds) {
    return [&, faults, seconds] { return paths({faults, seconds}, options, progress); };
  };
  return tablesOf({{0, "paths", course(false, 20)},
                   {0.25, "paths with faults", course(true, 20)},
                   {0.5, "five minutes", course(true, 300)},
                   {0.65, "hands", [&] { return hands(options, progress); }},
                   {0.7, "heights", [&] { return heightTable(options, progress); }},
                   {0.8, "stiffness", [&] { return stiffnessTable(options, progress); }}},
                  progress);
}

} // namespace patina
