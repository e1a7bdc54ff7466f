// A path and a mesh of another size: how much larger the path would have to be to lie on it best.
#pragma once

#include "acquisition/registration/path_fit.h"

namespace patina {

struct SimilarityFit {
  Pose mesh_from_path = Pose::Identity(); // of the path scaled about the middle of its points
  double scale = 1;                       // of the path
  double deviation = 0;                   // of it, one standard deviation
  double rms = 0;                         // of what counts [m]
  bool converged = false;
};

// Gauss-Newton over pose and scale, from a fit whose weights say what counts. Points that are worth
// one in `together` say as much of the scale. `pressed`: see FitOptions.
SimilarityFit fitSimilarity(const SurfaceTarget& target, const std::vector<Vec3>& points,
                            const Pose& mesh_from_path, const std::vector<bool>& counts,
                            const std::vector<double>& pressed, double together);

} // namespace patina
