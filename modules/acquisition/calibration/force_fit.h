// What a probe's force shows under known weights tells its zero and its gain (A05).
#pragma once

#include <optional>
#include <vector>

namespace patina {

struct KnownForce {
  double force = 0; // that presses [N]
  double shown = 0; // by the probe, in whatever unit
};

struct ForceFit {
  double zero = 0, gain = 1;         // force = gain (shown - zero)
  double zero_deviation = 0;         // [of shown]
  double gain_deviation = 0;         // [N of shown]
  double rms = 0;                    // of what was used, about the line [N]
  std::vector<std::size_t> rejected; // readings that contradict the others
};

// The weights count as exact. Robust against a quarter of wrong readings. Nothing with fewer than
// four readings or three different forces, or where what is shown hardly grows with the force.
std::optional<ForceFit> fitForce(const std::vector<KnownForce>& readings);

} // namespace patina
