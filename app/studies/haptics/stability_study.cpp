#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "app/studies/framework/studies.h"
#include "app/studies/framework/study.h"
#include "app/studies/haptics/bisection.h"
#include "app/studies/haptics/measured_limit.h"
#include "app/studies/paint/paint_shapes.h"
#include "haptics/law/plane.h"
#include "haptics/simulation/simulation.h"
#include "session/compile/compile_scene.h"

namespace patina {
namespace {

// Simulates the loop and measures the run time.
struct TimedRun {
  SimulationReport report;
  double seconds = 0; // wall time, minimum of three passes
  double ns = 0;      // per tick, device included
};

inline TimedRun timedRun(const HapticSnapshot& snapshot, const SimulationSpec& spec) {
  using Clock = std::chrono::steady_clock;
  Progress progress;
  TimedRun run;
  run.seconds = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < 3; ++pass) { // other load can only add time
    const auto start = Clock::now();
    run.report = simulate(snapshot, spec, progress);
    const std::chrono::duration<double> taken = Clock::now() - start;
    run.seconds = std::min(run.seconds, taken.count());
  }
  run.ns = 1e9 * run.seconds / static_cast<double>(run.report.ticks);
  return run;
}

// Closed loop on surfaces with several normals, with curvature near the tip's depth, or with relief
// or roughness.

constexpr double kBall = 2e-3;                    // [m]
constexpr double kSide = 0.04, kThickness = 0.01; // painted slab [m]
constexpr double kWave = 1e-3;                    // wavelength of the relief [m]
constexpr double kPi = std::numbers::pi;

using Field = std::shared_ptr<const SurfaceField>;

// Cube of `cells` per side about the origin.
Field fieldOf(const std::function<double(const Vec3&)>& phi, double voxel, int cells = 80) {
  FieldGrid grid;
  grid.voxel = voxel;
  grid.origin = Vec3::Constant(-0.5 * voxel * cells);
  grid.nodes = {cells + 1, cells + 1, cells + 1};
  return withSamples(std::make_shared<SurfaceField>(sampleFunction(phi, grid, 8)));
}

struct Place {
  std::string name;
  Field field;
  Vec3 surface = Vec3::Zero(), inward = -Vec3::UnitZ();
};

Place corner(const std::string& name, const std::vector<Vec3>& normals) {
  Vec3 out = Vec3::Zero();
  for (const Vec3& n : normals) out += n;
  const auto distance = [normals](const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& n : normals) least = std::min(least, n.dot(p));
    return least;
  };
  return {name, fieldOf(distance, 0.4e-3), Vec3::Zero(), -out.normalized()};
}

std::vector<Place> corners() {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto groove = [](double half_angle) {
    const double a = half_angle * kPi / 180;
    return std::vector<Vec3>{Vec3(std::cos(a), 0, std::sin(a)), Vec3(-std::cos(a), 0, std::sin(a))};
  };
  return {corner("inner corner, 2 planes", {Vec3::UnitX(), Vec3::UnitZ()}),
          corner("inner corner, 2 planes, turned", {turn * Vec3::UnitX(), turn * Vec3::UnitZ()}),
          corner("inner corner, 3 planes", {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}),
          corner("groove of 60 deg", groove(30)), corner("groove of 30 deg", groove(15))};
}

Place ball() {
  return {"ball of 2 mm radius", fieldOf([](const Vec3& p) { return p.norm() - kBall; }, 0.1e-3),
          Vec3(0, 0, kBall), Vec3(0.02, 0.01, -1).normalized()};
}
Place bowl() {
  constexpr double kBowl = 10e-3;
  return {"bowl of 10 mm radius", fieldOf([](const Vec3& p) { return kBowl - p.norm(); }, 0.4e-3),
          Vec3(0, 0, -kBowl)};
}
Place edge() {
  const Vec3 half = Vec3::Constant(8e-3);
  const auto distance = [half](const Vec3& p) {
    const Vec3 q = p.cwiseAbs() - half;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
  };
  return {"outer edge", fieldOf(distance, 0.25e-3, 96), Vec3(0, half.y(), half.z()),
          Vec3(0.01, -1, -1).normalized()};
}

Scene sceneOfStiffness(double stiffness, bool friction = false) {
  Scene scene;
  scene.haptics.stiffness = stiffness;
  scene.haptics.force_limit = 1000;
  if (friction) {
    Friction values;
    values.static_coefficient = 0.5;
    values.dynamic_coefficient = 0.4;
    scene.haptics.friction = values;
  }
  return scene;
}

// Presses as described by `place`, from a gap.
SimulationSpec pressedAt(const Place& place, double press, double gap) {
  SimulationSpec spec;
  spec.surface = place.surface;
  spec.inward = place.inward;
  spec.press = press;
  spec.depth = -gap;
  return spec;
}

bool decays(const HapticSnapshot& snapshot, const SimulationSpec& spec) {
  Progress progress;
  const SimulationReport run = simulate(snapshot, spec, progress);
  return run.rms_velocity < run.rms_early || run.rms_velocity < 1e-12;
}

void addLimit(WorkPrecisionTable& table, const std::string& name, double measured, double exact,
              const HapticSnapshot& half, const SimulationSpec& spec) {
  WorkPrecisionRow row;
  row.settings = {{"surface", name}};
  row.error = row.error_max = 100 * std::abs(measured / exact - 1);
  const TimedRun run = timedRun(half, spec);
  row.ns = run.ns;
  row.bytes = static_cast<double>(half.field->bytes());
  row.more = {{"measured [N/m]", measured},
              {"eigenvalues [N/m]", exact},
              {"wall s per simulated s", run.seconds / spec.seconds}};
  table.rows.push_back(std::move(row));
}

// Spring stiffness at which oscillations stop decaying.
void addSpringLimit(WorkPrecisionTable& table, const Place& place, bool friction, double hand,
                    double depth) {
  SimulationSpec spec = pressedAt(place, 0, -depth);
  spec.hand.stiffness = hand;
  const double exact = stiffnessLimit(sampledLoop(spec.device, spec.hand));
  const auto at = [&](double stiffness) {
    spec.press = stiffness * depth;
    spec.speed = 1e-6 * std::sqrt(stiffness / spec.device.mass);
    return compileStages(sceneOfStiffness(stiffness, friction), place.field);
  };
  const double measured = bisected(0.5 * exact, 1.5 * exact, 1e-4,
                                   [&](double stiffness) { return decays(*at(stiffness), spec); });
  const auto half = at(0.5 * exact);
  addLimit(table,
           place.name + (friction ? ", friction 0.5" : "") + (hand > 0 ? ", held from aside" : ""),
           measured, exact, *half, spec);
}

// F7: relief amplitude A of a valley, with lateral stiffness A k^2 P, at which oscillations
// stop decaying.
void addReliefLimit(WorkPrecisionTable& table, Progress& progress) {
  constexpr double kStiffness = 300, kPress = 0.5, kValley = 1.5e-3;
  const double k = 2 * kPi / kValley;
  Scene scene = slabScene(kSide, kThickness, 80);
  scene.haptics = sceneOfStiffness(kStiffness).haptics;
  layRelief(scene, kSide, 1024, [&](double x, double) { return -std::cos(k * x); });
  SimulationSpec spec;
  const double exact = stiffnessLimit(sampledLoop(spec.device));
  const auto at = [&](double stiffness) {
    scene.relief.height = stiffness / (kPress * k * k);
    spec.surface = Vec3(1e-6, 1e-4, -scene.relief.height);
    spec.depth = kPress / kStiffness;
    spec.press = kPress;
    spec.seconds = 12;
    return compile(scene, progress)->snapshot;
  };
  const double measured = bisected(0.5 * exact, 1.5 * exact, 1e-3,
                                   [&](double stiffness) { return decays(*at(stiffness), spec); });
  const auto half = at(0.5 * exact);
  addLimit(table, "relief of 1.5 mm, along its valley", measured, exact, *half, spec);
}

struct Rest {
  std::string name, steadied_by;
  double stiffness = 0; // [N/m]
  bool should = true;
};

void addRest(WorkPrecisionTable& table, const Rest& rest, const HapticSnapshot& snapshot,
             const SimulationSpec& spec) {
  const TimedRun run = timedRun(snapshot, spec);
  const SimulationReport& report = run.report;
  WorkPrecisionRow row;
  row.settings = {
      {"surface", rest.name}, {"K [N/m]", rest.stiffness}, {"steadied by", rest.steadied_by}};
  row.error = report.rms_velocity;
  row.error_max = report.rms_early;
  row.ns = run.ns;
  row.bytes = static_cast<double>(snapshot.field->bytes());
  row.more = {{"should rest", rest.should ? 1.0 : 0.0},
              {"rests", report.touches_late && report.rms_velocity <= 1e-6 ? 1.0 : 0.0},
              {"touches", report.touches_late ? 1.0 : 0.0},
              {"fault ticks", static_cast<double>(report.fault_ticks)},
              {"most depth [m]", report.max_depth},
              {"displayed [N/m]", report.stiffness_displayed.value_or(0)},
              {"wall s per simulated s", run.seconds / spec.seconds}};
  table.rows.push_back(std::move(row));
}

// T-P5: 2 N into corners, on a device with twice the damping that a plane needs, and on the default
// one with the automatic stabiliser.
void addCorners(WorkPrecisionTable& table, bool quick, Progress& progress) {
  for (const Place& place : corners())
    for (const bool automatic : {false, true})
      for (const double stiffness : automatic ? std::vector{1e3, 1e5, 1e7}
                                    : quick   ? std::vector{300., 2000.}
                                              : std::vector{300., 700., 2000.}) {
        progress.throwIfCancelled();
        Scene scene = sceneOfStiffness(stiffness);
        SimulationSpec spec = pressedAt(place, 2, 2e-3);
        spec.seconds = 24; // at 300 N/m it decays slowly
        if (automatic)
          scene.device_model = spec.device;
        else
          spec.device.damping = stiffness / spec.device.rate;
        addRest(table, {place.name, automatic ? "stabiliser" : "b = K T", stiffness},
                *compileStages(scene, place.field), spec);
      }
}

// The equilibrium on a ball and on an edge is unstable (-K d / (r - d)): friction, or a lateral
// hand stiffness of at least 3 P / (r - d), holds the tip there.
void addRidges(WorkPrecisionTable& table) {
  constexpr double kStiffness = 1000, kPress = 0.15 * kStiffness * kBall;
  for (const Place& place : {ball(), edge()})
    for (const char* by : {"nothing", "friction 0.5", "hand"}) {
      const bool friction = by[0] == 'f', hand = by[0] == 'h';
      Scene scene = sceneOfStiffness(kStiffness, friction);
      SimulationSpec spec = pressedAt(place, kPress, 0.2e-3);
      scene.device_model = spec.device;
      if (hand) spec.hand.stiffness = 3 * kPress / (kBall - kPress / kStiffness);
      addRest(table, {place.name, by, kStiffness, friction || hand},
              *compileStages(scene, place.field), spec);
    }
}

// 1 N on a slab with the automatic stabiliser.
void addTexture(WorkPrecisionTable& table, bool quick, Progress& progress) {
  struct Texture {
    std::string name;
    double relief = 0, roughness = 0; // [m], amplitude and rms
  };
  for (const Texture& texture : {Texture{"relief of 50 um, 1 mm wave", 50e-6, 0},
                                 Texture{"relief of 100 um, 1 mm wave", 100e-6, 0},
                                 Texture{"roughness of 50 um rms", 0, 50e-6}}) {
    Scene scene = slabScene(kSide, kThickness, 80);
    if (texture.relief > 0) {
      layRelief(scene, kSide, quick ? 512 : 1024,
                [](double x, double) { return std::cos(2 * kPi * x / kWave); });
      scene.relief.height = texture.relief;
    } else {
      layMaterial(scene, kSide, 0.5e-3, 4e-3, MaterialChannel::roughness,
                  [&](const Vec3&) { return texture.roughness; });
    }
    for (const double stiffness :
         quick ? std::vector{200., 2000.} : std::vector{200., 500., 1000., 2000.}) {
      progress.throwIfCancelled();
      SimulationSpec spec;
      spec.surface = Vec3(0.3e-3, 0.2e-3, 0);
      spec.depth = -0.5e-3;
      spec.press = 1;
      spec.seconds = 24;
      scene.haptics = sceneOfStiffness(stiffness).haptics;
      scene.device_model = spec.device;
      addRest(table, {texture.name, "stabiliser", stiffness}, *compile(scene, progress)->snapshot,
              spec);
    }
  }
}

// Stability limit of small oscillations, in N/m of the stiffest direction, against the eigenvalues
// of the loop: `error` in %. m = 0.1 kg, b = 0.5 N s/m, 1 kHz, no stabiliser.
WorkPrecisionTable loopLimitsOnSurfaces(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Where the loop on a surface stops settling, against eigenvalues (F7)", "%");
  for (const Place& place : corners()) {
    progress.throwIfCancelled();
    addSpringLimit(table, place, false, 0, 1e-3);
    if (options.quick) break;
  }
  addSpringLimit(table, bowl(), false, 0, 1e-3);
  addSpringLimit(table, ball(), true, 0, 0.3e-3);
  addSpringLimit(table, ball(), false, 600, 0.3e-3);
  addReliefLimit(table, progress);
  return table;
}

// A mass pressed onto the surface: `error` is the rms velocity of the last second [m/s],
// `error_max` of the 2nd; "rests" is 1 below 1e-6 m/s in contact, "should rest" the expected value.
WorkPrecisionTable restOnSurfaces(const StudyOptions& options, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Pressed into corners, onto ridges and textures: rms velocity in the last second "
              "and in the 2nd",
              "m/s");
  addCorners(table, options.quick, progress);
  addRidges(table);
  addTexture(table, options.quick, progress);
  return table;
}

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
  const double exact = stiffnessLimit(loop), rule = linearStabilityLimit(loop);
  const double measured = measuredStiffnessLimit(wall(0, damping), spec, 0.5 * exact, 1.5 * exact);
  spec.press = 1;
  const TimedRun run = timed(wall(0.5 * exact, damping), {}, spec);
  WorkPrecisionRow row;
  row.settings = {{"m [kg]", device.mass},
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

// Varies the entry phase: the tip starts at different fractions of a tick from the wall.
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
    row.settings = {{"rate [Hz]", rate}};
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
      row.settings = {{"fc [N]", friction}, {"b [N s/m]", damping}, {"step [m]", kStep}};
      row.error = row.error_max = 100 * std::abs(measured / expected - 1);
      row.ns = run.ns;
      row.more = {{"measured [N/m]", measured},
                  {"2 fc / step [N/m]", expected},
                  {"2b/T [N/m]", 2 * damping * spec.device.rate}};
      table.rows.push_back(std::move(row));
    }
  return table;
}

// The table of MATH 2.3: m = 0.1, b = 0.5, 1 kHz, pressed with 1 N, hit at 0.2 m/s.
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
        if (remedy.naive) spec.rate_limit = 2 * spec.device.damping * spec.device.rate;
        const HapticProperties haptics = wall(stiffness, remedy.damping);
        const StabiliserPlan plan = planStabilisers(haptics, spec.device, remedy.stabilisers);
        const TimedRun run = timed(haptics, plan, spec);
        const Verdict verdict = run.report.verdict;
        const bool settles = verdict == Verdict::kAtRest || verdict == Verdict::kDecaying;
        WorkPrecisionRow row;
        row.settings = {{"stabiliser", remedy.name}, {"K [N/m]", stiffness}, {"delay", delay}};
        row.error = run.report.rms_velocity;
        row.error_max = run.report.rms_early;
        row.ns = run.ns;
        row.more = {{"settles", settles ? 1.0 : 0.0},
                    {"displayed [N/m]", run.report.stiffness_displayed.value_or(0)},
                    {"coupling [N/m]", plan.coupling ? plan.coupling->stiffness : 0},
                    {"energy absorbed [J]", run.report.energy.absorbed},
                    {"least credited energy [J]", run.report.energy.lowest_absorbed_with_damping}};
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
