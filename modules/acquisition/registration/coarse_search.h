// Multi-start search for the pose of a path on a mesh, by distances on a coarse grid.
#pragma once

#include <vector>

#include "acquisition/registration/surface_target.h"
#include "core/progress.h"

namespace patina {

struct CoarseSearch {
  double rotation = 1.75;    // largest rotation about any axis [rad]; pi: all rotations
  double translation = 0.06; // largest translation in any direction [m]
  std::size_t keep = 6;      // number of distinct poses returned, the best first
  std::size_t starts = 1500; // poses tried at first; more for all rotations
  unsigned seed = 1;         // seed of the poses tried
};

// Returns poses near `start` at which the path is roughly on the surface. Throws Cancelled.
std::vector<Pose> coarsePoses(const SurfaceTarget& target, const std::vector<Vec3>& points,
                              const Pose& start, const CoarseSearch& search, Progress& progress);

} // namespace patina
