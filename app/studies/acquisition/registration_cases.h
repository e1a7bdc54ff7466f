// Test paths with a known pose on a mesh, for the registration.
#pragma once

#include <random>
#include <vector>

#include "acquisition/registration/surface_target.h"
#include "acquisition/values/scan_samples.h"
#include "core/progress.h"

namespace patina {

struct RegistrationSetting {
  int points = 300;
  double turn = 0, shift = 0; // errors of the initial pose, in random directions [rad, m]
  double noise = 0;           // standard deviation along each axis [m]
  double outliers = 0;        // share of points displaced by 5 to 20 mm
};

struct RegistrationCase {
  std::vector<Vec3> truth; // on the mesh
  std::vector<Vec3> path;  // scanned points; in the mesh frame unless a motion is added
  Pose start;
};

// Draws a closed curve around the mesh. Cases with the same seed differ only in the initial pose
// and the added errors.
RegistrationCase drawCase(const SurfaceTarget& target, const RegistrationSetting& setting,
                          unsigned seed);

// A simulated scan of a mesh from above, filtered, in contact.
struct ScannedCase {
  std::vector<PathSample> path;
  Pose mesh_from_path; // the truth
  double compliance;   // surface compliance [m/N]
};
ScannedCase scanCase(const TriangleMesh& mesh, double seconds, unsigned seed, Progress& progress);

// Rms distance of the transformed points from the truth [m].
double trueError(const Pose& mesh_from_path, const std::vector<Vec3>& truth);

// 100 mm square with waves of 10 to 80 mm, on which ICP converges slowly (F11).
TriangleMesh bumpySheet(int cells);

} // namespace patina
