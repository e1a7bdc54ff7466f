// A path and a mesh of another size: how much larger the path would have to be to lie on it best.
#pragma once

#include "acquisition/registration/error_law.h"

namespace patina {

struct SimilarityFit {
  Pose mesh_from_path = Pose::Identity(); // of the path scaled about the middle of its points
  double scale = 1;                       // of the path
  double deviation = 0;                   // of it, one standard deviation
  double rms = 0;                         // of what counts [m]
  bool converged = false;
};

// Gauss-Newton over pose and scale, from a fit that says what counts. Its deviation is by the
// errors that this fit leaves (errorLaw(): `noise` is the least), for those of a fit without a
// scale hold the misfit, too. `pressed`: see FitOptions.
SimilarityFit fitSimilarity(const SurfaceTarget& target, const std::vector<Vec3>& points,
                            const Pose& mesh_from_path, const std::vector<bool>& counts,
                            const std::vector<double>& pressed, double noise);

} // namespace patina
