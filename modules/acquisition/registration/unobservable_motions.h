// Motions of a path that its surface does not determine, such as shifts on a plane (A10).
#pragma once

#include <string>
#include <vector>

#include "acquisition/registration/path_fit.h"
#include "acquisition/registration/residual_noise.h"

namespace patina {

struct UnobservableMotion {
  enum class Kind { translation, rotation };
  Kind kind;
  Vec3 axis = Vec3::UnitZ();      // unit, in the mesh's frame
  Vec3 axis_point = Vec3::Zero(); // point on the axis of a rotation [m]
  double pitch = 0;               // translation along the axis per radian [m]
};
struct UnobservableMotions {
  std::vector<UnobservableMotion> named;
  Eigen::Matrix<double, 6, Eigen::Dynamic> basis; // orthonormal, in PoseScaling's lengths
};
std::string inWords(const UnobservableMotion& motion); // Returns "free to slide along (1, 0, 0)".

// Returns the motions whose deviation exceeds ten times `noise` [m]. Those with small eigenvalues
// of the normal equations are tried by this length to both sides; chordal errors of the mesh do not
// make a motion observable. `correlation_length`: see ResidualNoiseModel; `indentations`: see
// FitOptions.
UnobservableMotions unobservableMotions(const SurfaceTarget& target,
                                        const std::vector<Vec3>& points, const PathFit& fit,
                                        double noise, double correlation_length,
                                        const std::vector<double>& indentations);
// Adds directions whose deviation exceeds half the path's radius; correlated errors may hide what
// independent samples would determine.
void addPoorlyKnown(UnobservableMotions& free, const ResidualNoiseModel& law,
                    const PoseScaling& scale);

} // namespace patina
