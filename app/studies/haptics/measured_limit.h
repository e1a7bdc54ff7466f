// Where the simulated loop stops settling, found from trajectories alone.
#pragma once

#include "haptics/devices/simulation.h"
#include "scene/haptic_properties.h"

namespace patina {

// The stiffness at which a small oscillation about a pressed equilibrium on the plane stops
// decaying from the second second to the last, by bisection between `low` (decays) and `high` (does
// not), to 1e-4 of it. The tip never leaves the wall, so nothing but the loop itself decides: no
// stabilisers, no limit of the force. haptics.stiffness and depth, press and speed of `spec` are
// not read.
double measuredStiffnessLimit(HapticProperties haptics, const SimulationSpec& spec, double low,
                              double high);

} // namespace patina
