#include "app/studies/framework/studies.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/studies/framework/query_timing.h"
#include "app/studies/haptics/bisection.h"
#include "haptics/law/snapshot.h"
#include "haptics/loop_model/zoh_integrator.h"

namespace patina {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<double> rates(bool quick) {
  return quick ? std::vector{1000., 4000.} : std::vector{1000., 2000., 5000., 10000.};
}

// Friction on the plane z = 0, solid below.
std::shared_ptr<const HapticSnapshot> rubbed(double voxel, double stiffness, double fixed,
                                             double sliding, Friction::SlipDirection slip,
                                             double damping = 0) {
  constexpr int kCells = 64;
  FieldGrid grid;
  grid.voxel = voxel;
  grid.origin = Vec3::Constant(-0.5 * voxel * kCells);
  grid.nodes = {kCells + 1, kCells + 1, kCells + 1};
  Scene scene;
  scene.haptics.stiffness = stiffness;
  scene.haptics.force_limit = 1000;
  if (damping > 0) scene.haptics.damping = damping;
  Friction friction;
  friction.static_coefficient = fixed;
  friction.dynamic_coefficient = sliding;
  friction.slip = slip;
  scene.haptics.friction = friction;
  return compileStages(scene, withSamples(std::make_shared<SurfaceField>(
                                  sampleFunction([](const Vec3& p) { return p.z(); }, grid, 8))));
}

// Contact at `tip` from straight above, slowly, because a blow would count as a fault.
ContactMemory landedAt(const HapticSnapshot& snapshot, const Vec3& tip, double period) {
  constexpr double kSpeed = 0.1; // [m/s]
  ContactMemory memory;
  for (double z = 1e-4; z > tip.z(); z -= kSpeed * period)
    tick(snapshot, memory, Vec3(tip.x(), tip.y(), z), period);
  tick(snapshot, memory, tip, period);
  return memory;
}

double nsPerTick(const HapticSnapshot& snapshot, const std::vector<Vec3>& tips, double period) {
  ContactMemory memory = landedAt(snapshot, tips.front(), period);
  return nsPerQuery(tips,
                    [&](const Vec3& tip) { return tick(snapshot, memory, tip, period).depth; });
}

// --- T-K09b: a stroke back and forth dissipates 4 mu K d (A - mu d).

constexpr double kSoft = 500, kDeep = 2e-3, kCoefficient = 0.4; // K [N/m], d [m], mu

// The error depends on where the extremes fall between two ticks, so several phases are tried.
WorkPrecisionRow cycleRow(const HapticSnapshot& snapshot, double rate, double frequency,
                          double amplitude, int phases) {
  const double period = 1 / rate;
  const double exact = 4 * kCoefficient * kSoft * kDeep * (amplitude - kCoefficient * kDeep);
  const int cycle = static_cast<int>(std::lround(rate / frequency));
  std::vector<Vec3> tips;
  WorkPrecisionRow row;
  row.settings = {
      {"rate [Hz]", rate}, {"strokes [Hz]", frequency}, {"amplitude [mm]", 1e3 * amplitude}};
  double mean = 0;
  for (int phase = 0; phase < phases; ++phase) {
    tips.clear();
    for (int i = 0; i <= cycle; ++i) {
      const double angle = 2 * kPi * (i + static_cast<double>(phase) / phases) / cycle;
      tips.emplace_back(amplitude * std::sin(angle), 0, -kDeep);
    }
    ContactMemory memory = landedAt(snapshot, tips[0], period);
    for (int i = 0; i < cycle; ++i)
      tick(snapshot, memory, tips[static_cast<std::size_t>(i)], period);
    double taken = 0, last_force = 0;
    for (std::size_t i = 0; i < tips.size(); ++i) {
      const double force = tick(snapshot, memory, tips[i], period).force.x();
      if (i > 0) taken -= 0.5 * (force + last_force) * (tips[i].x() - tips[i - 1].x());
      last_force = force;
    }
    const double error = 100 * std::abs(taken / exact - 1);
    row.error += error * error / phases;
    row.error_max = std::max(row.error_max, error);
    mean += taken / phases;
  }
  row.error = std::sqrt(row.error);
  row.ns = nsPerTick(snapshot, tips, period);
  row.bytes = static_cast<double>(snapshot.field->bytes());
  row.more = {{"top speed [m/s]", 2 * kPi * frequency * amplitude},
              {"mean energy [J]", mean},
              {"4 mu K d (A - mu d) [J]", exact}};
  return row;
}

WorkPrecisionTable cycles(bool quick, Progress& progress) {
  WorkPrecisionTable table = tableOf("Energy of a cycle against 4 mu K d (A - mu d) (T-K09b), rms "
                                     "and max over phases; order 2 in v T",
                                     "%");
  const auto snapshot =
      rubbed(0.5e-3, kSoft, kCoefficient, kCoefficient, Friction::SlipDirection::paper);
  OrderFit order;
  for (const double rate : rates(quick))
    for (const double frequency : {0.5, 2., 8.})
      for (const double amplitude : {1e-3, 2e-3, 5e-3}) {
        progress.throwIfCancelled();
        table.rows.push_back(cycleRow(*snapshot, rate, frequency, amplitude, quick ? 8 : 32));
        if (amplitude == 2e-3) order.add(frequency / rate, table.rows.back().error);
      }
  order.into(table, 2);
  return table;
}

// --- T-K09e: stick-slip of a mass dragged by a spring.

struct Drag {
  double mass = 0.1, spring = 200;       // m [kg], k [N/m]
  double most = 1.2, sliding = 0.8;      // F_s, F_k [N]
  double stiffness = 20e3, damping = 30; // K [N/m], B [N s/m] of the surface: it settles at 1 kHz
  double depth = 1e-4;                   // [m]
  double speed = 0;                      // V [m/s]
};

double rigidPeriod(const Drag& drag) {
  const double w = std::sqrt(drag.spring / drag.mass);
  const double A = (drag.most - drag.sliding) / drag.spring;
  return 2 * A / drag.speed + 2 / w * (kPi - std::atan(A * w / drag.speed));
}

// The same with the surface's own spring and damper. The tip creeps at u until spring and damper
// together reach F_s; it then yields until the surface alone has given F_s / K, and slips until it
// stops. Friction is constant in the last two phases, so the dragging spring's length is a cosine.
double stickSlipPeriod(const Drag& drag) {
  const double k = drag.spring, K = drag.stiffness, V = drag.speed;
  const double w = std::sqrt(k / drag.mass), u = V * k / (k + K);
  const double left = drag.damping * u / K; // remaining displacement when it begins to yield
  const double yield = bisected(
      0, 1 / w, 1e-12, [&](double t) { return V * t - (V - u) / w * std::sin(w * t) < left; });
  const double A = (drag.most - drag.sliding) / k + (V - u) / w * std::sin(w * yield);
  const double lengthens = (V - u) * std::cos(w * yield);
  const double slip =
      (2 * kPi - std::atan2(A * w, lengthens) - std::acos(V / std::hypot(A * w, lengthens))) / w;
  const double short_of = A * std::cos(w * slip) + lengthens / w * std::sin(w * slip);
  const double stick = ((drag.most - drag.sliding) * (1 / k + 1 / K) - left - short_of) / V;
  return stick + yield + slip;
}

struct Periods {
  std::vector<double> lasted; // duration of each [s]
  double ns = 0;              // per tick, device included
};

Periods stickSlipPeriods(const HapticSnapshot& snapshot, const Drag& drag, double rate,
                         double about, std::size_t count) {
  constexpr double kBegin = -0.055; // start [m]; the field has room for all periods
  const double period = 1 / rate;
  // The spring is at rest in the hand's frame, so that the step is exact.
  const ZohIntegrator step({drag.mass, 0, drag.spring, 0}, period);
  Motion motion{0, -drag.speed};
  ContactMemory memory = landedAt(snapshot, Vec3(kBegin, 0, -drag.depth), period);
  const auto start = std::chrono::steady_clock::now();
  Periods periods;
  int slips = 0, ticks = 0;
  double last = 0;
  bool slipped = false;
  for (; periods.lasted.size() < count && ticks * period < 3 * about * static_cast<double>(count);
       ++ticks) {
    const double t = ticks * period;
    const Vec3 tip(kBegin + motion.x + drag.speed * t, 0, -drag.depth);
    motion = step(motion, tick(snapshot, memory, tip, period).force.x());
    if (memory.friction.slipping() && !slipped && (slips == 0 || t - last > 0.3 * about)) {
      // the first one had other initial conditions
      if (++slips > 2) periods.lasted.push_back(t - last);
      last = t;
    }
    slipped = memory.friction.slipping();
  }
  const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
  periods.ns = taken.count() / ticks;
  return periods;
}

// The loop settles on a whole number of ticks per period. This rounding error differs at every
// speed, so several similar speeds are used.
WorkPrecisionRow stickSlipRow(const HapticSnapshot& snapshot, Drag drag, double rate) {
  constexpr int kSpeeds = 8;
  const double speed = drag.speed;
  WorkPrecisionRow row;
  row.settings = {{"rate [Hz]", rate}, {"speed [m/s]", speed}};
  row.bytes = static_cast<double>(snapshot.field->bytes());
  row.ns = std::numeric_limits<double>::infinity();
  row.more = {{"closed form [s]", stickSlipPeriod(drag)}, {"rigid [s]", rigidPeriod(drag)}};
  double mean = 0, count = 0;
  for (int i = 0; i < kSpeeds; ++i) {
    drag.speed = speed * (1 + 0.01 * i);
    const double exact = stickSlipPeriod(drag);
    const Periods periods = stickSlipPeriods(snapshot, drag, rate, exact, 4);
    for (const double lasted : periods.lasted) {
      const double error = 100 * std::abs(lasted / exact - 1);
      row.error += error * error;
      row.error_max = std::max(row.error_max, error);
      mean += 100 * (lasted / exact - 1);
      ++count;
    }
    row.ns = std::min(row.ns, periods.ns);
  }
  row.error = std::sqrt(row.error / count);
  row.more.emplace_back("mean error [%]", mean / count);
  row.more.emplace_back("periods", count);
  return row;
}

WorkPrecisionTable stickSlip(bool quick, Progress& progress) {
  WorkPrecisionTable table = tableOf("Period of stick and slip (T-K09e) against its closed form, "
                                     "rms and max over speeds within 7 %; order 1 in T",
                                     "%");
  Drag drag;
  const double normal = drag.stiffness * drag.depth;
  const auto snapshot = rubbed(2e-3, drag.stiffness, drag.most / normal, drag.sliding / normal,
                               Friction::SlipDirection::paper, drag.damping);
  OrderFit order;
  for (const double rate : rates(quick))
    for (const double speed : {0.005, 0.02, 0.05}) {
      progress.throwIfCancelled();
      drag.speed = speed;
      table.rows.push_back(stickSlipRow(*snapshot, drag, rate));
      // Measured in periods, which depend on the speed.
      order.add(1 / (rate * stickSlipPeriod(drag)), table.rows.back().error);
    }
  order.into(table, 1);
  return table;
}

// --- On a circle the dragged contact point lags by asin(mu d / r); displacement does not.

constexpr double kCircle = 4e-3, kShallow = 1e-3; // [m]

WorkPrecisionRow directionRow(const HapticSnapshot& snapshot, double rate, double speed,
                              double lag) {
  const double period = 1 / rate, turn = speed / kCircle * period; // [rad] per tick
  const auto tipAt = [&](int i) {
    return Vec3(kCircle * std::cos(turn * i), kCircle * std::sin(turn * i), -kShallow);
  };
  const int settle = static_cast<int>(2 / turn), count = static_cast<int>(2 * kPi / turn);
  ContactMemory memory = landedAt(snapshot, tipAt(0), period);
  std::vector<Vec3> tips;
  WorkPrecisionRow row;
  row.settings = {{"rate [Hz]", rate}, {"speed [m/s]", speed}};
  double mean = 0;
  for (int i = 0; i < settle + count; ++i) {
    const Vec3 tip = tipAt(i);
    const Vec3 force = tick(snapshot, memory, tip, period).force;
    if (i < settle) continue;
    tips.push_back(tip);
    const Vec2 back = Vec2(tip.y(), -tip.x()) / kCircle, out = Vec2(tip.x(), tip.y()) / kCircle;
    const Vec2 drag(force.x(), force.y());
    const double angle = std::atan2(-drag.dot(out), drag.dot(back));
    const double error = 180 / kPi * std::abs(angle - lag);
    mean += 180 / kPi * angle / count;
    row.error += error / count;
    row.error_max = std::max(row.error_max, error);
  }
  row.ns = nsPerTick(snapshot, tips, period);
  row.bytes = static_cast<double>(snapshot.field->bytes());
  row.more = {{"lag [deg]", mean}, {"closed form [deg]", 180 / kPi * lag}};
  return row;
}

WorkPrecisionTable directions(Friction::SlipDirection slip, bool quick, Progress& progress) {
  const bool paper = slip == Friction::SlipDirection::paper;
  WorkPrecisionTable table =
      tableOf(paper ? "Direction on a circle, paper's slip: it lags by asin(mu d / r); mean and "
                      "max; order 1 in v T"
                    : "Direction on a circle, slip by displacement: it does not lag; mean and max",
              "deg");
  const auto snapshot = rubbed(0.2e-3, kSoft, kCoefficient, kCoefficient, slip);
  const double lag = paper ? std::asin(kCoefficient * kShallow / kCircle) : 0;
  OrderFit order;
  for (const double rate : rates(quick))
    for (const double speed : {0.02, 0.1, 0.4}) {
      progress.throwIfCancelled();
      table.rows.push_back(directionRow(*snapshot, rate, speed, lag));
      order.add(speed / rate, table.rows.back().error);
    }
  if (paper) order.into(table, 1);
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> frictionStudy(const StudyOptions& options, Progress& progress) {
  using Slip = Friction::SlipDirection;
  const bool quick = options.quick;
  return tablesOf(
      {{0, "energy of a cycle", [&] { return cycles(quick, progress); }},
       {0.4, "stick and slip", [&] { return stickSlip(quick, progress); }},
       {0.8, "direction of slip", [&] { return directions(Slip::paper, quick, progress); }},
       {0.9, "direction of slip", [&] { return directions(Slip::displacement, quick, progress); }}},
      progress);
}

} // namespace patina
