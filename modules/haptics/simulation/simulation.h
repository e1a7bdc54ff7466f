// Closed loop of servo, device and hand in simulated time (MATH 2).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/progress.h"
#include "haptics/law/snapshot.h"
#include "haptics/loop_model/stability_limit.h"
#include "haptics/stability/passivity_observer.h"

namespace patina {

struct PeriodRange {
  double shortest = 0, longest = 0; // uniform distribution of tick lengths [s]
};
struct MissedTick {
  double at = 0;    // the first tick from this time on [s]
  double lasts = 0; // time for which its force is held [s]
};
struct Teleport {
  double at = 0;          // [s]
  Vec3 by = Vec3::Zero(); // [m]
};

struct SimulationSpec {
  DeviceModel device;
  HandModel hand;   // moves with the device; its spring is relaxed at the start
  double press = 0; // constant force along `inward` [N]

  // The run starts `depth` below the point `surface` along `inward` (negative: a gap), moving
  // inwards with `speed`. The device's axes, along which friction and encoder act, are `inward` and
  // two perpendicular ones; the encoder counts from `surface`.
  Vec3 surface = Vec3::Zero();
  Vec3 inward = -Vec3::UnitZ(); // unit
  double depth = 0;             // [m]
  double speed = 0;             // [m/s]

  double seconds = 8;
  std::optional<double> saturation{}; // limit of the device's force [N]; the vector is scaled
  std::optional<PeriodRange> jitter{};
  std::optional<MissedTick> missed{};
  std::optional<Teleport> teleport{}; // moves device and hand
  // Rate limit |dF| <= c |dx| per tick [N/m]: the negative control of F13, never used in a servo.
  std::optional<double> rate_limit{};
  unsigned seed = 1; // seed of the jitter
};

// Output of the force law for one tick: the servo's, or one of a test.
struct LawOutput {
  Vec3 force = Vec3::Zero();
  bool touching = false;
  bool fault = false;
  double depth = 0; // [m]
};
using ForceLaw = std::function<LawOutput(const Vec3& tip, double dt)>;

struct SimulationRow {
  double t = 0;
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 force = Vec3::Zero(); // applied by the device from t on
  double energy = 0;         // energy absorbed so far [J]
};
using RowSink = std::function<void(const SimulationRow&)>;

// Outcome of a run, in this order of precedence.
enum class Verdict {
  kLeftSurface, // no contact in the last second, but earlier or at the start
  kAtRest,      // RMS velocity of the last second below 1e-8 m/s
  kDecaying,    // stable, decaying in the second half (or nearly at rest), without energy input
  kUnstable
};
// Returns "left the surface", "at rest", "calming down", "does not settle".
const char* name(Verdict verdict);

struct SimulationReport {
  // True if the last second's RMS velocity is below 0.9 times the second one's, or 1e-8 m/s.
  bool stable = false;
  double rms_velocity = 0; // last second [m/s]
  double rms_early = 0;    // from 1 s to 2 s [m/s]
  double rms_middle = 0;   // the second around half time [m/s]
  Verdict verdict = Verdict::kUnstable;
  // Largest increase of the energy of device, hand and press over its start [J]. A passive surface
  // returns at most the energy stored at the start (plus a teleport's work).
  double energy_gained = 0;
  double max_depth = 0;      // measured by the servo [m]
  bool touches_late = false; // contact in the last second
  double max_force = 0;      // applied [N]
  PassivityObserver energy;  // [J]
  // Mean force over mean depth along `inward` in the last second [N/m]; absent without contact.
  std::optional<double> stiffness_displayed;
  // Coefficient of restitution of the first contact with an inward speed: outgoing over incoming
  // speed along `inward`, the former after the contact's last force has acted. Absent if no contact
  // ended, if a pressed tip never returned, and for values outside 0 .. 10.
  std::optional<double> restitution;
  std::uint64_t ticks = 0;
  std::uint64_t contact_ticks = 0;
  std::uint64_t fault_ticks = 0;
};

// Throws std::invalid_argument for values out of range (also seconds below 3). Polls progress.
SimulationReport simulate(const ForceLaw& law, const SimulationSpec& spec, Progress& progress,
                          const RowSink& row = {});
SimulationReport simulate(const HapticSnapshot& snapshot, const SimulationSpec& spec,
                          Progress& progress, const RowSink& row = {});

} // namespace patina
