// Iterated closest points (ICP, Besl & McKay 1992), as in the paper (A10): alternates closest
// points and a rigid fit until the mean distance no longer changes.
#pragma once

#include "acquisition/registration/surface_target.h"

namespace patina {

struct IcpOptions {
  int iterations = 500;
  double tolerance = 1e-9; // tolerance of the mean distance [m]
  bool affine = false;     // fitAffineThenRigid() instead of fitRigid()
};

struct IcpResult {
  Pose mesh_from_path = Pose::Identity();
  double mean_distance = 0, mean_square = 0; // [m, m^2]
  double last_rotation = 0,
         last_translation = 0; // last step [rad, m], as slow convergence resembles none
  int iterations = 0;
  bool converged = false;
  bool fell_back = false; // the path is planar: fitRigid() replaced the affine fit
};

// Ignores the target's offset. Throws std::invalid_argument if no point is finite.
IcpResult iteratedClosestPoints(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                const Pose& start, const IcpOptions& options = {});

} // namespace patina
