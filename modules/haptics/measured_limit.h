// Where the simulated loop stops settling, found from trajectories alone.
#pragma once

#include "haptics/simulation.h"
#include "scene/haptic_properties.h"

namespace patina {

// Whether a small oscillation about a pressed equilibrium on the plane decays from the second
// second to the last. The tip never leaves the wall, so nothing but the loop itself decides. Depth,
// press and speed of `spec` are set here; no stabilisers, no limit of the force.
bool oscillationDecays(const HapticProperties& haptics, SimulationSpec spec);

// The stiffness at which it stops decaying, by bisection between `low` (decays) and `high` (does
// not), to 1e-4 of it. haptics.stiffness is not read.
double measuredStiffnessLimit(HapticProperties haptics, const SimulationSpec& spec, double low,
                              double high);

} // namespace patina
