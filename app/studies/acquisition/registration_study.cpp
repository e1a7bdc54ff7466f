#include "app/studies/framework/studies.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/registration/iterated_closest_points.h"
#include "acquisition/registration/register_path.h"
#include "app/studies/acquisition/registration_cases.h"
#include "app/studies/acquisition/registration_consistency.h"
#include "app/studies/acquisition/stroke_trials.h"
#include "app/studies/framework/query_timing.h"
#include "core/percentiles.h"
#include "field/surface/models.h"

namespace patina {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Found {
  Pose pose;
  int iterations;
};

struct Method {
  const char* name;
  bool loop;
  bool literal = false; // the loop's fit as the paper describes it
};
constexpr Method kOurs{"ours", false}, kLoop{"closest points", true},
    kLiteral{"closest points, 4x4", true, true};

Found place(const Method& method, const SurfaceTarget& target, const RegistrationCase& given,
            double noise) {
  if (method.loop) {
    IcpOptions options;
    options.affine = method.literal;
    const IcpResult found = iteratedClosestPoints(target, given.path, given.start, options);
    return {found.mesh_from_path, found.iterations};
  }
  RegistrationOptions options;
  options.noise = noise;
  Progress progress;
  const Registration found = registerPath(target, given.path, given.start, options, progress);
  return {found.mesh_from_path, found.iterations};
}

struct Trials {
  std::vector<double> errors; // [m]
  double seconds = 0, iterations = 0;

  double rms() const {
    double squares = 0;
    for (const double error : errors) squares += error * error;
    return std::sqrt(squares / static_cast<double>(errors.size()));
  }
};

Trials trialsOf(const Method& method, const SurfaceTarget& target,
                const RegistrationSetting& setting, unsigned count) {
  Trials trials;
  for (unsigned seed = 1; seed <= count; ++seed) {
    const RegistrationCase given = drawCase(target, setting, seed);
    const double begin = threadSeconds();
    const Found found = place(method, target, given, setting.noise);
    trials.seconds += (threadSeconds() - begin) / count;
    trials.iterations += static_cast<double>(found.iterations) / count;
    trials.errors.push_back(trueError(found.pose, given.truth));
  }
  return trials;
}

WorkPrecisionRow rowOf(const Trials& trials, double error) {
  WorkPrecisionRow row;
  row.error = 1e3 * error;
  row.error_max = 1e3 * *std::max_element(trials.errors.begin(), trials.errors.end());
  row.ns = 1e9 * trials.seconds;
  row.more = {{"iterations", trials.iterations}};
  return row;
}

unsigned trialCount(const StudyOptions& options) {
  return options.quick ? 3 : options.thorough ? 200 : 20;
}

WorkPrecisionTable methods(const SurfaceTarget& target, const StudyOptions& options,
                           Progress& progress) {
  constexpr double kFound = 0.05e-3; // [m], without noise
  const unsigned count = trialCount(options);
  WorkPrecisionTable table =
      tableOf("300 points on a dinosaur of 100 mm (A10): true error, median and worst of " +
                  std::to_string(count) +
                  "; found is what errs by less than the noise, or 0.05 mm without any",
              "mm");
  trialsOf(kOurs, target, {}, 1); // warms the cache
  for (const auto& [degrees, millimetres] : {std::pair{5, 3}, {15, 10}, {60, 40}})
    for (const double outliers : {0., 0.2})
      for (const double noise : {0., 0.1e-3, 0.5e-3})
        for (const Method& method : {kOurs, kLoop, kLiteral}) {
          progress.throwIfCancelled();
          const RegistrationSetting setting{.turn = kDegree * degrees,
                                            .shift = 1e-3 * millimetres,
                                            .noise = noise,
                                            .outliers = outliers};
          const Trials trials = trialsOf(method, target, setting, count);
          WorkPrecisionRow row = rowOf(trials, percentiles(trials.errors).p50);
          row.settings = {{"method", method.name},
                          {"turn [deg]", degrees},
                          {"shift [mm]", millimetres},
                          {"outliers [%]", 100 * outliers},
                          {"noise [mm]", 1e3 * noise}};
          const auto found =
              std::count_if(trials.errors.begin(), trials.errors.end(),
                            [&](double error) { return error < std::max(noise, kFound); });
          row.more.emplace_back("found [%]", 100. * static_cast<double>(found) / count);
          table.rows.push_back(row);
        }
  return table;
}

Pose afterSteps(int iterations, const SurfaceTarget& target, const RegistrationCase& given,
                const Pose& start) {
  FitOptions options;
  options.iterations = iterations;
  return fitPath(target, given.path, start, options).mesh_from_path;
}

Pose afterRounds(int iterations, const SurfaceTarget& target, const RegistrationCase& given,
                 const Pose& start) {
  IcpOptions options;
  options.iterations = iterations;
  options.tolerance = 0;
  return iteratedClosestPoints(target, given.path, start, options).mesh_from_path;
}

// Estimates the order from pairs of an error and its successor. Few points change their face, so
// the surface is locally smooth.
template <class After>
WorkPrecisionTable convergence(const std::string& title, const std::vector<int>& iterations,
                               double order, const After& after, const StudyOptions& options,
                               Progress& progress) {
  constexpr double kRounding = 1e-15; // [m]
  WorkPrecisionTable table =
      tableOf(title + ", a bumpy sheet without noise, from 0.3 deg and 0.3 mm: true error so far, "
                      "median and worst; order of an error by the one before",
              "mm");
  const SurfaceTarget target(bumpySheet(10), 0);
  const unsigned count = options.quick ? 5 : trialCount(options);
  OrderFit fit;
  for (const int many : iterations) {
    progress.throwIfCancelled();
    Trials trials;
    std::vector<double> left;
    for (unsigned seed = 1; seed <= count; ++seed) {
      const RegistrationCase given =
          drawCase(target, {.turn = 0.3 * kDegree, .shift = 0.3e-3}, seed);
      const double begin = threadSeconds();
      const Pose pose = after(many, target, given, given.start);
      trials.seconds += (threadSeconds() - begin) / count;
      trials.errors.push_back(trueError(pose, given.truth));
      const double next = trueError(after(1, target, given, pose), given.truth);
      left.push_back(next / trials.errors.back());
      if (next > kRounding) fit.add(trials.errors.back(), next);
    }
    trials.iterations = many;
    WorkPrecisionRow row = rowOf(trials, percentiles(trials.errors).p50);
    row.settings = {{"iterations", many}};
    row.more = {{"one more leaves", percentiles(left).p50}};
    table.rows.push_back(row);
  }
  fit.into(table, order);
  return table;
}

WorkPrecisionTable numbers(const SurfaceTarget& target, const StudyOptions& options,
                           Progress& progress) {
  WorkPrecisionTable table = tableOf("True error by the number of points (T-A11d), from 5 deg and "
                                     "3 mm, rms and worst; order at 0.05 mm of noise",
                                     "mm");
  OrderFit order;
  for (const double noise : {0.05e-3, 0.2e-3})
    for (const int points : {50, 100, 200, 400, 800, 1600}) {
      progress.throwIfCancelled();
      const Trials trials = trialsOf(
          kOurs, target, {.points = points, .turn = 5 * kDegree, .shift = 3e-3, .noise = noise},
          5 * trialCount(options));
      WorkPrecisionRow row = rowOf(trials, trials.rms());
      row.settings = {{"noise [mm]", 1e3 * noise}, {"points", points}};
      // Six parameters from one distance per point.
      row.more.emplace_back("of noise sqrt(6/n)", trials.rms() / noise * std::sqrt(points / 6.));
      table.rows.push_back(row);
      if (noise < 0.1e-3) order.add(points, row.error);
    }
  order.into(table, -0.5);
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> registrationStudy(const StudyOptions& options, Progress& progress) {
  const SurfaceTarget target(dinosaur(), 0);
  return tablesOf(
      {{0, "methods", [&] { return methods(target, options, progress); }},
       {0.8, "Gauss-Newton",
        [&] {
          return convergence("Gauss-Newton (T-A10b)", {0, 1, 2}, 2, afterSteps, options, progress);
        }},
       {0.85, "closest points",
        [&] {
          return convergence("Closest points (F11)", {0, 1, 2, 5, 10, 20, 50, 100, 200, 500}, 1,
                             afterRounds, options, progress);
        }},
       {0.9, "number of points", [&] { return numbers(target, options, progress); }},
       {0.95, "simulated scans", [&] { return consistencyTable(options, progress); }},
       {0.98, "next strokes", [&] { return strokeTable(options, progress); }}},
      progress);
}

} // namespace patina
