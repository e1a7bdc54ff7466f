#include "app/studies/haptics/loop_on_surfaces.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "app/studies/haptics/bisection.h"
#include "app/studies/haptics/loop_run.h"
#include "app/studies/paint/paint_shapes.h"
#include "session/build/compile_scene.h"

namespace patina {
namespace {

constexpr double kBall = 2e-3;                    // [m]
constexpr double kSide = 0.04, kThickness = 0.01; // [m], of the painted slab
constexpr double kWave = 1e-3;                    // [m], of the relief
constexpr double kPi = std::numbers::pi;

using Field = std::shared_ptr<const SurfaceField>;

// On `cells` a side about the origin.
Field fieldOf(const std::function<double(const Vec3&)>& phi, double voxel, int cells = 80) {
  FieldGrid grid;
  grid.voxel = voxel;
  grid.origin = Vec3::Constant(-0.5 * voxel * cells);
  grid.nodes = {cells + 1, cells + 1, cells + 1};
  return withSamples(std::make_shared<SurfaceField>(sampleFunction(phi, grid, 8)));
}

// Where a tip is pressed.
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

// Pressed at `place` as it is said there, from a gap.
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
  row.knobs = {{"surface", name}};
  row.error = row.error_max = 100 * std::abs(measured / exact - 1);
  const TimedRun run = timedRun(half, spec);
  row.ns = run.ns;
  row.bytes = static_cast<double>(half.field->bytes());
  row.more = {{"measured [N/m]", measured},
              {"eigenvalues [N/m]", exact},
              {"wall s per simulated s", run.seconds / spec.seconds}};
  table.rows.push_back(std::move(row));
}

// The stiffness of a spring at which it stops settling.
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

// F7: the amplitude A at which a valley of relief, A k^2 P stiff along the surface, stops settling.
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
  row.knobs = {
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
        spec.seconds = 24; // at 300 N/m it calms down slowly
        if (automatic)
          scene.device_model = spec.device;
        else
          spec.device.damping = stiffness / spec.device.rate;
        addRest(table, {place.name, automatic ? "stabiliser" : "b = K T", stiffness},
                *compileStages(scene, place.field), spec);
      }
}

// On a ball and on an edge the equilibrium is unstable in itself, by -K d / (r - d): friction or a
// hand of at least 3 P / (r - d) from aside holds the tip there.
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

} // namespace

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

} // namespace patina
