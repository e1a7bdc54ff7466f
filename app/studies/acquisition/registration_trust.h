// Does a registration know how well it knows? Simulated scans of made bodies, whose place is known.
#pragma once

#include <string>
#include <vector>

#include "acquisition/registration/surface_target.h"
#include "app/studies/study.h"

namespace patina {

// One scan, registered as `patina register` does without a first guess.
struct TrustTrial {
  bool warned = false;   // not converged, or not unique
  std::size_t free = 0;  // motions that were named as such
  double error = 0;      // in what is seen: of the points, rms [m]
  double deviations = 0; // the same, in the deviations that were stated
  double nees = 0;       // squared error in those, by freedom
  double seconds = 0;    // of processor time
};
TrustTrial trustTrial(const SurfaceTarget& target, double seconds, unsigned seed,
                      Progress& progress);

struct TrustBody {
  std::string name;
  TriangleMesh mesh;
};
// From above, a dinosaur, the same from its side, a stone and a bumpy sheet; `count` of them.
std::vector<TrustBody> trustBodies(std::size_t count);

// Scans of 4, 8 and 20 s; each row a body and a length.
WorkPrecisionTable trustTable(const StudyOptions& options, Progress& progress);

} // namespace patina
