// A surface that yields to the force that a probe presses with, by so much a newton: found together
// with the pose (A30).
#pragma once

#include "acquisition/registration/path_fit.h"

namespace patina {

// A compliance that is nothing out of the ordinary, one deviation [m/N]: of 1000 N/m.
constexpr double kYields = 1e-3;

double usualForce(const std::vector<double>& force); // rms [N]

struct YieldingFit {
  PathFit fit;
  double compliance = 0; // 0 or more [m/N]
};

// From a fit that took the surface for hard. `force` [N]: one a point. A fit whose points are worth
// one in `together` says as much of the compliance. Asks for a target with sides.
YieldingFit fitYielding(const SurfaceTarget& target, const std::vector<Vec3>& points,
                        const std::vector<double>& force, const PathFit& hard, double together,
                        const FitOptions& options);

} // namespace patina
