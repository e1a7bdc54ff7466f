// The closed loop of servo, device and hand in simulated time (MATH 2).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/progress.h"
#include "haptics/servo/snapshot.h"
#include "haptics/stability/energy_ledger.h"
#include "haptics/stability/stability_limit.h"

namespace patina {

struct PeriodRange {
  double shortest = 0, longest = 0; // [s]; each tick's length is uniform between them
};
struct MissedTick {
  double at = 0;    // [s]: the first tick from then on
  double lasts = 0; // [s]; its force is held so long
};
struct Teleport {
  double at = 0;          // [s]
  Vec3 by = Vec3::Zero(); // [m]
};

struct SimulationSpec {
  DeviceModel device;
  HandModel hand;   // moves with the device; its spring rests at the start
  double press = 0; // [N], constant, along `inward`

  // The run begins `depth` below the point `surface` along `inward` (a gap is a negative depth),
  // moving inward with `speed`. The device's axes, on each of which its friction and encoder act,
  // are `inward` and two across; the encoder counts from `surface`.
  Vec3 surface = Vec3::Zero();
  Vec3 inward = -Vec3::UnitZ(); // unit
  double depth = 0;             // [m]
  double speed = 0;             // [m/s]

  double seconds = 8;
  std::optional<double> saturation{}; // [N], of the device: the vector is scaled
  std::optional<PeriodRange> jitter{};
  std::optional<MissedTick> missed{};
  std::optional<Teleport> teleport{}; // moves device and hand
  // [N/m]: |dF| <= c |dx| a tick. The negative control of F13; never in a servo.
  std::optional<double> naive_limit{};
  unsigned seed = 1; // of the jitter
};

// What the loop feels: a tick of the servo, or a law of a test's own.
struct Felt {
  Vec3 force = Vec3::Zero();
  bool touching = false;
  bool fault = false;
  double depth = 0; // [m]
};
using ForceLaw = std::function<Felt(const Vec3& tip, double dt)>;

struct SimulationRow {
  double t = 0;
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 force = Vec3::Zero(); // what the device applies from t on
  double energy = 0;         // [J], absorbed so far
};
using RowSink = std::function<void(const SimulationRow&)>;

// What became of the tip, in this order of precedence.
enum class Verdict {
  kLeftSurface, // not touching in the last second, though it had touched or began inside
  kAtRest,      // rms of the last second below 1e-8 m/s
  kCalmingDown, // stable, calmer still over the second half (or all but still), fed by nothing
  kUnsettled
};
// "left the surface", "at rest", "calming down", "does not settle".
const char* name(Verdict verdict);

struct SimulationReport {
  // From the trajectory alone: the last second's rms velocity is below 0.9 times the second
  // second's, or below 1e-8 m/s.
  bool stable = false;
  double rms_velocity = 0; // [m/s], last second
  double rms_early = 0;    // [m/s], from 1 s to 2 s
  double rms_middle = 0;   // [m/s], the second about half time
  Verdict verdict = Verdict::kUnsettled;
  // Most that the energy of device, hand and press stood above its start [J]. A passive surface
  // gives no more than it stored at the start (a teleport's work counts as given).
  double energy_gained = 0;
  double max_depth = 0;      // [m], as the servo saw it
  bool touches_late = false; // in the last second
  double max_force = 0;      // [N], applied
  EnergyLedger energy;       // [J]
  // Mean force against mean depth below `surface`, along `inward`, over the last second [N/m];
  // absent where nothing was touched or the depth is zero.
  std::optional<double> stiffness_displayed;
  // Speed out over speed in along `inward` of the first contact that began with a speed; out is
  // taken when the last force of that contact has worked. Absent if none ended, if a tip that is
  // pressed never came back, and where the ratio is no bounce's (not from 0 to 10).
  std::optional<double> restitution;
  std::uint64_t ticks = 0;
  std::uint64_t contact_ticks = 0;
  std::uint64_t fault_ticks = 0;
};

// Throws std::invalid_argument for values out of range (seconds below 3, too). Polls progress.
SimulationReport simulate(const ForceLaw& law, const SimulationSpec& spec, Progress& progress,
                          const RowSink& row = {});
SimulationReport simulate(const HapticSnapshot& snapshot, const SimulationSpec& spec,
                          Progress& progress, const RowSink& row = {});

} // namespace patina
