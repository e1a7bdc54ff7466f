// The paper's loop (A10): each point's nearest on the mesh, a fit of points onto points, again,
// until the mean distance no longer changes.
#pragma once

#include "acquisition/registration/surface_target.h"

namespace patina {

struct LoopOptions {
  int iterations = 500;
  double still = 1e-9;  // change of the mean distance at which it stops [m]
  bool literal = false; // fitAffineThenRigid() in place of fitRigid()
};

struct LoopFit {
  Pose mesh_from_path = Pose::Identity();
  double mean_distance = 0, mean_square = 0; // [m, m^2]
  double last_turn = 0, last_shift = 0; // of the last step [rad, m]: slow progress looks like none
  int iterations = 0;
  bool converged = false;
  bool fell_back = false; // a path in a plane: the literal fit does not exist, fitRigid() was used
};

// The offset of the target is not taken into account. Points that are not finite do not count;
// throws std::invalid_argument where none is.
LoopFit closestPointLoop(const SurfaceTarget& target, const std::vector<Vec3>& points,
                         const Pose& start, const LoopOptions& options = {});

} // namespace patina
