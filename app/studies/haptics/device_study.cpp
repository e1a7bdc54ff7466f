#include "app/studies/framework/studies.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "app/studies/haptics/bisection.h"
#include "haptics/catalog/device_catalog.h"
#include "haptics/falcon/emulated_falcon.h"
#include "haptics/falcon/falcon_device.h"
#include "haptics/falcon/falcon_frame.h"
#include "haptics/law/plane.h"
#include "haptics/law/stabilisers.h"
#include "haptics/link/link_loop.h"
#include "haptics/loop_model/stability_limit.h"
#include "haptics/servo/cross_fade.h"
#include "haptics/simulation/wire_benchmark.h"

namespace patina {
namespace {

// Max stiffness of a sampled wall on a device with dry friction or backlash, where it depends on
// the handle's speed (MATH 2.1.8).
struct GearNonlinearity {
  double friction = 0; // Coulomb friction at the handle [N]
  double play = 0;     // backlash of the measured position, at the handle [m]
};

constexpr double kPi = std::numbers::pi;

bool dies(SampledLoop loop, const GearNonlinearity& gear, double stiffness,
          const std::function<double(double)>& speed) {
  // Backlash lowers the frequency below that of K alone; two iterations suffice.
  double share = 1, lag = 0, fast = 0;
  for (int i = 0; i < 4; ++i) {
    const double omega = std::sqrt((share * stiffness + loop.hand_stiffness) / loop.mass);
    fast = speed(omega);
    const double half = gear.play / 2, way = fast / omega; // amplitude of the handle
    if (way <= half) return true; // within the backlash: nothing is measured
    const double part = half / way, root = std::sqrt(part * (1 - part));
    share = 0.5 + (std::asin(1 - 2 * part) + 2 * (1 - 2 * part) * root) / kPi;
    lag = 4 / kPi * part * (1 - part) / omega; // [s]
  }
  loop.damping += 4 * gear.friction / (kPi * fast) - stiffness * lag;
  return loop.damping >= 0 && spectralRadius(loop, share * stiffness) < 1;
}

// Stiffness of a limit cycle, by describing functions of friction and backlash (Gelb & Vander Velde
// 1968). `speed` [m/s] is the oscillation's amplitude at a frequency [rad/s]. Without friction and
// backlash equal to stiffnessLimit(loop); 0 if every stiffness is unstable.
double limitCycleStiffness(const SampledLoop& loop, const GearNonlinearity& gear,
                           const std::function<double(double)>& speed) {
  const double high = 4 * loop.mass / (loop.period * loop.period);
  double low = 1e-4 * high;
  if (!dies(loop, gear, low, speed)) return 0;
  double next = low;
  while (next < high && dies(loop, gear, next, speed)) low = next, next *= 1.1;
  return bisected(low, next, 1e-6, [&](double k) { return dies(loop, gear, k, speed); });
}

constexpr double kTick = 1e-3;

// Servo tick with driver, wire and mechanics, in simulated time.
class Loop {
 public:
  Loop(const FalconEmulatorSpec& spec, std::shared_ptr<const HapticSnapshot> snapshot)
      : clock_(std::make_shared<SimulatedClock>()), notes_(std::make_shared<LinkStatistics>()),
        bench(spec, clock_),
        link_(makeFalconLink([this] { return bench.plug(); }, {}, clock_), guard(), clock_, notes_),
        snapshot_(std::move(snapshot)) {
    law_.fadeTo(snapshot_.get());
  }
  // Only the device's own force limit stays: the guard is not under test.
  static GuardSpec guard() {
    GuardSpec spec;
    spec.ramp = kTick;
    return spec;
  }
  void tick() {
    due_ += kTick;
    clock_->waitUntil(due_);
    const DeviceState& state = link_.step({force_, clock_->now()});
    force_.setZero();
    if (effectiveStatus(state) == DeviceStatus::ok) force_ = law_.tick(state.position, kTick).force;
    ++ticks;
  }
  double rms(double seconds) {
    double sum = 0;
    const int count = static_cast<int>(seconds / kTick);
    for (int i = 0; i < count; ++i) {
      tick();
      sum += std::pow(bench.velocity().z(), 2);
    }
    return std::sqrt(sum / count);
  }
  double force() const { return force_.z(); }

 private:
  std::shared_ptr<SimulatedClock> clock_;
  std::shared_ptr<LinkStatistics> notes_;

 public:
  FalconEmulator bench;
  std::uint64_t ticks = 0;

 private:
  LinkLoop link_;
  std::shared_ptr<const HapticSnapshot> snapshot_;
  CrossFade law_;
  Vec3 force_ = Vec3::Zero();
  double due_ = 0;
};

HapticProperties wall(double stiffness) {
  HapticProperties haptics;
  haptics.stiffness = stiffness;
  haptics.force_limit = std::numeric_limits<double>::infinity();
  return haptics;
}

constexpr double kBlow = 0.6, kFor = 0.01; // force and duration of a blow [N], [s]

// Presses the handle gently into the wall, then strikes it: is the final oscillation smaller than
// after the blow? With backlash it never stops.
bool decays(double stiffness, const FalconEmulatorSpec& spec, std::uint64_t& ticks) {
  constexpr double kPress = 4, kWatched = 0.2; // [N], [s]
  Loop loop(spec, planeSnapshot(wall(stiffness), {}));
  for (int i = 0; i < 1000; ++i) {
    loop.bench.push = Vec3(0, 0, -1e-3 * i * kPress);
    loop.tick();
  }
  loop.bench.push = Vec3(0, 0, -kPress - kBlow);
  loop.rms(kFor);
  loop.bench.push = Vec3(0, 0, -kPress);
  loop.rms(1);
  const double late = loop.rms(kWatched);
  ticks += loop.ticks;
  return late < kBlow * kFor / spec.body.mass / std::numbers::sqrt2;
}

// Displacement of the centred handle for an angular backlash of all three thighs.
double atHandle(double play) {
  const FalconShape shape;
  const Angles middle = falconAngles(shape, kFalconCentre).value();
  const Vec3 there = falconPose(shape, middle + play * Angles::Ones(), kFalconCentre).handle;
  return (there - kFalconCentre).norm();
}

WorkPrecisionTable limits(bool quick, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Where a wall on the emulated Falcon begins to buzz, against eigenvalues with a "
              "delay of one sample (MATH 2.1.3), with friction and play for a swing as fast as "
              "the blow makes it (2.1.8)",
              "%");
  struct Case {
    double mass, damping, spring, friction, backlash;
  };
  std::vector<Case> cases{{.25, 3, 60, 0, 0},
                          {.25, 5, 60, 0, 0},
                          {.15, 3, 60, 0, 0},
                          {.25, 3, 60, .03, 0},
                          {.25, 3, 60, 0, 5e-4}};
  if (!quick)
    for (const Case& more :
         {Case{.4, 3, 60, 0, 0}, Case{.25, 3, 300, 0, 0}, Case{.25, 3, 60, .05, 0},
          Case{.25, 3, 60, 0, 1e-3}, Case{.25, 5, 60, 0, 1e-3}, Case{.25, 3, 60, .03, 5e-4}})
      cases.push_back(more);
  for (const Case& c : cases) {
    progress.throwIfCancelled();
    const FalconEmulatorSpec spec{
        .body = {.mass = c.mass, .damping = c.damping, .spring = c.spring, .friction = c.friction},
        .backlash = c.backlash};
    const SampledLoop sampled{.mass = c.mass,
                              .damping = c.damping,
                              .hand_stiffness = c.spring,
                              .period = kTick,
                              .delay = 1};
    // The blow's duration is not short against the oscillation.
    const auto speed = [&](double omega) {
      return 2 * kBlow / (c.mass * omega) * std::abs(std::sin(omega * kFor / 2));
    };
    const double predicted =
        limitCycleStiffness(sampled, {c.friction, atHandle(c.backlash)}, speed);
    const auto start = std::chrono::steady_clock::now();
    std::uint64_t ticks = 0;
    const double measured = bisected(0.5 * predicted, 1.6 * predicted, 5e-3, [&](double stiffness) {
      return decays(stiffness, spec, ticks);
    });
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    WorkPrecisionRow row;
    row.settings = {{"m [kg]", c.mass},
                    {"b [N s/m]", c.damping},
                    {"hand [N/m]", c.spring},
                    {"friction [N]", c.friction},
                    {"play [rad]", c.backlash}};
    row.error = row.error_max = 100 * std::abs(measured / predicted - 1);
    row.ns = 1e9 * taken.count() / static_cast<double>(ticks);
    row.more = {{"measured [N/m]", measured},
                {"predicted [N/m]", predicted},
                {"eigenvalues alone [N/m]", stiffnessLimit(sampled)}};
    table.rows.push_back(std::move(row));
  }
  return table;
}

WorkPrecisionTable displayed(bool quick, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Stiffness displayed on the emulated Falcon behind the automatic stabiliser, against "
              "the two springs in series (MATH 2.3)",
              "%");
  const DeviceModel model = deviceNamed("falcon").model;
  const std::vector<double> stiffnesses =
      quick ? std::vector{500., 1e5} : std::vector{200., 500., 1000., 2000., 5000., 1e4, 1e5};
  for (const double stiffness : stiffnesses) {
    progress.throwIfCancelled();
    const HapticProperties haptics = wall(stiffness);
    const StabiliserPlan plan = planStabilisers(haptics, model, std::nullopt);
    Loop loop({.body = {.mass = model.mass, .damping = model.damping, .spring = 60, .friction = 0}},
              planeSnapshot(haptics, plan));
    loop.bench.push = Vec3(0, 0, -2);
    const auto start = std::chrono::steady_clock::now();
    loop.rms(3);
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    double depth = 0, force = 0, low = 1, high = -1;
    for (int i = 0; i < 1000; ++i) {
      loop.tick();
      const double z = loop.bench.handle().z();
      depth -= 1e-3 * z;
      force += 1e-3 * loop.force();
      low = std::min(low, z);
      high = std::max(high, z);
    }
    const double expected = plan.seriesStiffness(stiffness), measured = force / depth;
    WorkPrecisionRow row;
    row.settings = {{"K [N/m]", stiffness}};
    row.error = row.error_max = 100 * std::abs(measured / expected - 1);
    row.ns = taken.count() * kTick / 3;
    row.more = {{"displayed [N/m]", measured},
                {"expected [N/m]", expected},
                {"limit [N/m]", plan.predicted_limit.value_or(0)},
                {"coupling [N/m]", plan.coupling ? plan.coupling->stiffness : 0},
                {"moves [m]", high - low},
                {"depth [m]", depth}};
    table.rows.push_back(std::move(row));
  }
  return table;
}

// Resolution for one count of any encoder and for one value of any motor.
WorkPrecisionTable quantisation(bool quick, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("One count of an encoder, over the workspace at each height", "m");
  const FalconShape shape;
  const int steps = quick ? 8 : 40;
  for (const double z : {-0.04, -0.02, 0., 0.02, 0.04}) {
    progress.throwIfCancelled();
    WorkPrecisionRow row;
    row.settings = {{"z [m]", z}};
    double squares = 0, force_most = 0, force_squares = 0;
    int count = 0;
    const auto start = std::chrono::steady_clock::now();
    for (int ring = 0; ring <= steps; ++ring)
      for (int turn = 0; turn < 3 * steps; ++turn) {
        const double radius = 0.045 * ring / steps,
                     angle = 2 * std::numbers::pi * turn / (3 * steps);
        const Vec3 place =
            kFalconCentre + Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
        const auto angles = falconAngles(shape, place);
        if (!angles) continue;
        Eigen::Matrix3d torques; // torques of the three unit forces
        for (int i = 0; i < 3; ++i)
          torques.col(i) =
              falconTorques(shape, place, *angles, Vec3::Unit(i)).value_or(Vec3::Zero());
        const Eigen::Matrix3d forces = torques.inverse();
        for (int leg = 0; leg < 3; ++leg) {
          Angles next = *angles;
          next[leg] += kFalconCount;
          const double step = (falconPose(shape, next, place).handle - place).norm();
          const double push = forces.col(leg).norm() * kFalconFullTorque / kMaxMotor;
          squares += step * step;
          force_squares += push * push;
          row.error_max = std::max(row.error_max, step);
          force_most = std::max(force_most, push);
          ++count;
        }
      }
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    row.error = std::sqrt(squares / count);
    row.ns = taken.count() / count;
    row.more = {{"one motor value, rms [N]", std::sqrt(force_squares / count)},
                {"one motor value, most [N]", force_most}};
    table.rows.push_back(std::move(row));
  }
  return table;
}

WorkPrecisionTable turns(bool quick, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Round trips over the emulated wire in real time, p99.9 and longest beyond a bare "
              "timer's",
              "us");
  for (const unsigned faults : {0U, 10U})
    for (const int load : {0, 2}) {
      const WireBenchmark run = runOnEmulatedWire(
          {.seconds = quick ? 0.5 : 10, .faults_per_thousand = faults, .load = load}, progress);
      WorkPrecisionRow row;
      row.settings = {{"faults a thousand", static_cast<int>(faults)}, {"load [threads]", load}};
      row.error = std::max(0.0, run.round_us.p999 - run.bare_round_us.p999);
      row.error_max = std::max(0.0, run.round_us.max - run.bare_round_us.max);
      row.ns = 1e3 * run.round_us.p50;
      row.more = {{"round trip p50 [us]", run.round_us.p50},
                  {"p99 [us]", run.round_us.p99},
                  {"p99.9 [us]", run.round_us.p999},
                  {"bare p99.9 [us]", run.bare_round_us.p999},
                  {"late p99.9 [us]", run.late_us.p999},
                  {"bare late p99.9 [us]", run.bare_late_us.p999},
                  {"age p50 [us]", run.age_us.p50},
                  {"age p99 [us]", run.age_us.p99},
                  {"ticks", static_cast<double>(run.ticks)},
                  {"missed", static_cast<double>(run.missed)},
                  {"injected", static_cast<double>(run.injected)},
                  {"unnoticed", static_cast<double>(run.undetected_faults)},
                  {"faults by injection", static_cast<double>(run.causes.injected)},
                  {"faults by delay", static_cast<double>(run.causes.delayed)},
                  {"faults by neither", static_cast<double>(run.causes.unexplained)},
                  {"old places felt", static_cast<double>(run.outdated_states)}};
      table.rows.push_back(std::move(row));
    }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> deviceStudy(const StudyOptions& options, Progress& progress) {
  const bool quick = options.quick;
  return tablesOf({{0, "one count", [&] { return quantisation(quick, progress); }},
                   {0.1, "where it buzzes", [&] { return limits(quick, progress); }},
                   {0.4, "what is displayed", [&] { return displayed(quick, progress); }},
                   {0.5, "round trips", [&] { return turns(quick, progress); }}},
                  progress);
}

} // namespace patina
