// First guesses for a path whose place on a mesh is hardly known: many poses tried at little cost
// each, on distances from the mesh at the nodes of a coarse grid.
#pragma once

#include <vector>

#include "acquisition/registration/surface_target.h"
#include "core/progress.h"

namespace patina {

struct CoarseSearch {
  double turn = 1.75;        // about any axis, at most [rad]; pi = any turn
  double shift = 0.06;       // in any direction, at most [m]
  std::size_t keep = 6;      // poses that differ, the best first
  std::size_t starts = 1500; // poses tried at first; those for any turn are more
  unsigned seed = 1;         // which poses are tried; the same seed, the same poses
};

// Poses near `start` at which the path lies on the surface, roughly. Throws Cancelled.
std::vector<Pose> coarsePoses(const SurfaceTarget& target, const std::vector<Vec3>& points,
                              const Pose& start, const CoarseSearch& search, Progress& progress);

} // namespace patina
