#include "app/studies/haptics/stability_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/studies/haptics/bisection.h"
#include "app/studies/haptics/loop_on_surfaces.h"
#include "app/studies/haptics/loop_run.h"
#include "app/studies/haptics/measured_limit.h"
#include "haptics/contact/plane.h"

namespace patina {
namespace {

HapticProperties wall(double stiffness, double damping = 0) {
  HapticProperties haptics;
  haptics.stiffness = stiffness;
  if (damping > 0) haptics.damping = damping;
  haptics.force_limit = std::numeric_limits<double>::infinity();
  return haptics;
}

TimedRun timed(const HapticProperties& haptics, const StabiliserPlan& plan,
               const SimulationSpec& spec) {
  return timedRun(*planeSnapshot(haptics, plan), spec);
}

void addBoundary(WorkPrecisionTable& table, const DeviceModel& device, double damping,
                 Progress& progress) {
  progress.throwIfCancelled();
  SimulationSpec spec;
  spec.device = device;
  const SampledLoop loop = sceneLoop(wall(0, damping), device);
  const double exact = stiffnessLimit(loop), rule = ruleOfThumb(loop);
  const double measured = measuredStiffnessLimit(wall(0, damping), spec, 0.5 * exact, 1.5 * exact);
  spec.press = 1;
  const TimedRun run = timed(wall(0.5 * exact, damping), {}, spec);
  WorkPrecisionRow row;
  row.knobs = {{"m [kg]", device.mass},
               {"b [N s/m]", device.damping},
               {"rate [Hz]", device.rate},
               {"delay", device.delay},
               {"B [N s/m]", damping}};
  row.error = row.error_max = 100 * std::abs(measured / exact - 1);
  row.ns = run.ns;
  row.more = {{"measured [N/m]", measured},
              {"eigenvalues [N/m]", exact},
              {"rule of thumb [N/m]", rule},
              {"rule's error [%]", 100 * (rule / exact - 1)},
              {"wall s per simulated s", run.seconds / spec.seconds}};
  table.rows.push_back(std::move(row));
}

WorkPrecisionTable boundaries(bool quick, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Where the loop stops settling, against eigenvalues (MATH 2.1.2, 2.1.3)", "%");
  for (const auto& [mass, damping] :
       {std::pair{.05, .5}, {.1, .1}, {.1, .5}, {.1, 5.}, {.1, 50.}, {.2, 1.}})
    addBoundary(table, {mass, damping, 0, 0, 1000, 0}, 0, progress);
  for (const double rate : {500., 2000., 10000.})
    addBoundary(table, {.1, .5, 0, 0, rate, 0}, 0, progress);
  const std::vector<int> delays = quick ? std::vector{1, 5} : std::vector{0, 1, 2, 3, 4, 5};
  for (const int delay : delays)
    for (const double damping : {0., .5, 1., 2., 5.})
      addBoundary(table, {.1, .5, 0, 0, 1000, delay}, damping, progress);
  return table;
}

// Over entry phases: the tip starts a different part of a tick's way off the wall.
WorkPrecisionTable restitution(bool quick, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Restitution against the damped half wave (F4), rms and max over entry phases; "
              "error O(T)",
              "1");
  const int phases = quick ? 40 : 200;
  const double mass = .1, stiffness = 400, damping = .8;
  std::vector<double> periods, errors;
  for (const double rate : {500., 1000., 2000., 4000., 8000.}) {
    progress.throwIfCancelled();
    const double effective = damping - 0.5 * stiffness / rate;
    const double share = effective / (2 * std::sqrt(stiffness * mass));
    const double half_wave = std::exp(-std::numbers::pi * share / std::sqrt(1 - share * share));
    const double formula =
        std::exp(-0.5 * std::numbers::pi * effective / std::sqrt(stiffness * mass));
    WorkPrecisionRow row;
    row.knobs = {{"rate [Hz]", rate}};
    double mean = 0;
    for (int i = 0; i < phases; ++i) {
      SimulationSpec spec;
      spec.device = {mass, damping, 0, 0, rate, 0};
      spec.speed = .2;
      spec.depth = -1e-3 - i * spec.speed / rate / phases;
      spec.seconds = 3;
      Progress none;
      const double measured =
          simulate(*planeSnapshot(wall(stiffness), {}), spec, none).restitution.value_or(0);
      const double error = std::abs(measured / half_wave - 1);
      mean += measured / phases;
      row.error += error * error / phases;
      row.error_max = std::max(row.error_max, error);
    }
    row.error = std::sqrt(row.error);
    SimulationSpec spec;
    spec.device.rate = rate;
    row.ns = timed(wall(stiffness), {}, spec).ns;
    row.more = {{"mean", mean},
                {"half wave", half_wave},
                {"formula", formula},
                {"mean against formula [%]", 100 * (mean / formula - 1)}};
    periods.push_back(1 / rate);
    errors.push_back(row.error_max);
    table.rows.push_back(std::move(row));
  }
  table.order_fitted = fittedOrder(periods, errors);
  table.order_expected = 1;
  return table;
}

WorkPrecisionTable quantiser(Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Where an encoder step starts to chatter, against K = 2 fc / step (F5)", "%");
  for (const double friction : {.02, .05})
    for (const double damping : {.05, 5.}) {
      progress.throwIfCancelled();
      constexpr double kStep = 30e-6, kLevel = 20.5;
      const double expected = 2 * friction / kStep;
      SimulationSpec spec;
      spec.device = {.1, damping, friction, kStep, 1000, 0};
      spec.depth = kLevel * kStep;
      TimedRun run;
      const double measured = bisected(0.5 * expected, 1.5 * expected, 1e-4, [&](double stiffness) {
        spec.press = kLevel * stiffness * kStep;
        run = timed(wall(stiffness), {}, spec);
        return run.report.rms_velocity == 0;
      });
      WorkPrecisionRow row;
      row.knobs = {{"fc [N]", friction}, {"b [N s/m]", damping}, {"step [m]", kStep}};
      row.error = row.error_max = 100 * std::abs(measured / expected - 1);
      row.ns = run.ns;
      row.more = {{"measured [N/m]", measured},
                  {"2 fc / step [N/m]", expected},
                  {"2b/T [N/m]", 2 * damping * spec.device.rate}};
      table.rows.push_back(std::move(row));
    }
  return table;
}

// The table of 2.3: m = 0.1, b = 0.5, 1 kHz, pressed with 1 N, hit at 0.2 m/s.
WorkPrecisionTable remedies(bool quick, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Stabilisers (2.3): rms velocity in the 8th second and in the 2nd one", "m/s");
  struct Remedy {
    const char* name;
    double damping;
    std::optional<Stabilisers> stabilisers;
    bool naive;
  };
  const Stabilisers none{};
  const Remedy list[] = {{"plain", 0, none, false},
                         {"B = 2", 2, none, false},
                         {"B = 5", 5, none, false},
                         {"naive limiter", 0, none, true},
                         {"passivity", 0, Stabilisers{false, true}, false},
                         {"coupling", 0, Stabilisers{true, false}, false},
                         {"coupling,passivity", 0, Stabilisers{true, true}, false}};
  const std::vector<double> stiffnesses =
      quick ? std::vector{3000., 1e5} : std::vector{900., 3000., 1e4, 1e5, 1e7};
  for (const int delay : {0, 2})
    for (const double stiffness : stiffnesses)
      for (const Remedy& remedy : list) {
        progress.throwIfCancelled();
        SimulationSpec spec;
        spec.device.delay = delay;
        spec.press = 1;
        spec.speed = .2;
        if (remedy.naive) spec.naive_limit = 2 * spec.device.damping * spec.device.rate;
        const HapticProperties haptics = wall(stiffness, remedy.damping);
        const StabiliserPlan plan = planStabilisers(haptics, spec.device, remedy.stabilisers);
        const TimedRun run = timed(haptics, plan, spec);
        const Verdict verdict = run.report.verdict;
        const bool settles = verdict == Verdict::kAtRest || verdict == Verdict::kCalmingDown;
        WorkPrecisionRow row;
        row.knobs = {{"stabiliser", remedy.name}, {"K [N/m]", stiffness}, {"delay", delay}};
        row.error = run.report.rms_velocity;
        row.error_max = run.report.rms_early;
        row.ns = run.ns;
        row.more = {{"settles", settles ? 1.0 : 0.0},
                    {"displayed [N/m]", run.report.stiffness_displayed.value_or(0)},
                    {"coupling [N/m]", plan.coupling ? plan.coupling->stiffness : 0},
                    {"energy absorbed [J]", run.report.energy.absorbed},
                    {"least credited energy [J]", run.report.energy.lowest_credited}};
        table.rows.push_back(std::move(row));
      }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> stabilityStudy(const StudyOptions& options, Progress& progress) {
  return tablesOf({{0, "boundary", [&] { return boundaries(options.quick, progress); }},
                   {0.2, "restitution", [&] { return restitution(options.quick, progress); }},
                   {0.3, "encoder and dry friction", [&] { return quantiser(progress); }},
                   {0.4, "stabilisers", [&] { return remedies(options.quick, progress); }},
                   {0.5, "curved surfaces, corners and relief",
                    [&] { return loopLimitsOnSurfaces(options, progress); }},
                   {0.6, "rest on surfaces", [&] { return restOnSurfaces(options, progress); }}},
                  progress);
}

} // namespace patina
