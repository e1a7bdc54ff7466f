// Stability limit of the simulated loop, from trajectories alone.
#pragma once

#include "haptics/simulation/simulation.h"
#include "scene/haptic_properties.h"

namespace patina {

// Stiffness at which a small oscillation about a pressed equilibrium on the plane stops decaying
// between the second second and the last, by bisection between `low` (decays) and `high` (does
// not), to 1e-4. The tip never leaves the wall and there are no stabilisers and no force limit, so
// only the loop matters. haptics.stiffness and depth, press and speed of `spec` are ignored.
double measuredStiffnessLimit(HapticProperties haptics, const SimulationSpec& spec, double low,
                              double high);

} // namespace patina
