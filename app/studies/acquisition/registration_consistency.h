// Consistency of the registration's stated covariance, on simulated scans with a known pose.
#pragma once

#include <string>
#include <vector>

#include "acquisition/registration/surface_target.h"
#include "app/studies/framework/study.h"

namespace patina {

// One scan, registered as by `patina register` without an initial pose.
struct ConsistencyTrial {
  bool warned = false;   // not converged, or ambiguous
  std::size_t free = 0;  // number of motions reported as unobservable
  double error = 0;      // rms of the points in observable directions [m]
  double deviations = 0; // the same, in stated standard deviations
  double nees = 0;       // normalised squared error per degree of freedom (Bar-Shalom et al. 2001)
  double seconds = 0;    // processor time
};
ConsistencyTrial trustTrial(const SurfaceTarget& target, double seconds, unsigned seed,
                            Progress& progress);

struct TrustBody {
  std::string name;
  TriangleMesh mesh;
};
// A dinosaur from above and from its side, a stone and a bumpy sheet: the first `count` of them.
std::vector<TrustBody> trustBodies(std::size_t count);

// Scans of 4, 8 and 20 s; one row per body and length.
WorkPrecisionTable consistencyTable(const StudyOptions& options, Progress& progress);

} // namespace patina
