// Motions of a path that its surface does not see (A10): a path on a plane slides, on a sphere it
// turns.
#pragma once

#include <string>
#include <vector>

#include "acquisition/registration/error_law.h"
#include "acquisition/registration/path_fit.h"

namespace patina {

struct FreeMotion {
  enum class Kind { slide, turn };
  Kind kind;
  Vec3 axis = Vec3::UnitZ();   // unit, in the mesh's frame: along it, or about it
  Vec3 through = Vec3::Zero(); // a turn's axis goes through this point [m]
  double pitch = 0;            // a turn's shift along its axis a radian [m]
};
struct FreeMotions {
  std::vector<FreeMotion> named;
  Eigen::Matrix<double, 6, Eigen::Dynamic> basis; // orthonormal, in MotionScale's lengths
};
std::string inWords(const FreeMotion& motion); // "free to slide along (1, 0, 0)"

// Motions that the fit cannot tell to ten times `noise` [m]: each that the normal equations call
// weak is tried, to both sides, by as much. What the mesh's flat faces make of it counts as unseen.
// `together`: see ErrorLaw; `pressed`: see FitOptions.
FreeMotions freeMotions(const SurfaceTarget& target, const std::vector<Vec3>& points,
                        const PathFit& fit, double noise, double together,
                        const std::vector<double>& pressed);
// Adds what the errors leave known no better than to half the path's radius: neighbours that err
// alike may leave nothing of what each sample alone still sees.
void addUnknown(FreeMotions& free, const ErrorLaw& law, const MotionScale& scale);

} // namespace patina
