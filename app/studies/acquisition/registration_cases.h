// Paths whose place on a mesh is known, for what finds it.
#pragma once

#include <random>
#include <vector>

#include "acquisition/registration/surface_target.h"
#include "acquisition/scan_samples.h"
#include "core/progress.h"

namespace patina {

struct RegistrationSetting {
  int points = 300;
  double turn = 0, shift = 0; // of the first guess, about any axis and in any direction [rad, m]
  double noise = 0;           // deviation along each axis [m]
  double outliers = 0;        // share of points that lie 5 to 20 mm elsewhere
};

struct RegistrationCase {
  std::vector<Vec3> truth; // on the mesh
  std::vector<Vec3> path;  // what was scanned; in its place where no motion is added
  Pose start;
};

// A closed curve that winds round the mesh. The same seed, the same case, but for the guess and
// what is added to the points.
RegistrationCase drawCase(const SurfaceTarget& target, const RegistrationSetting& setting,
                          unsigned seed);

// A simulated scan of a mesh from above, filtered, in contact.
struct ScannedCase {
  std::vector<PathSample> path;
  Pose mesh_from_path; // the truth
  double compliance;   // of the surface [m/N]
};
ScannedCase scanCase(const TriangleMesh& mesh, double seconds, unsigned seed, Progress& progress);

// How far the points are taken from where they belong, rms [m].
double trueError(const Pose& mesh_from_path, const std::vector<Vec3>& truth);

// 100 mm square with waves of 10 to 80 mm, on which an alignment slides slowly (F11).
TriangleMesh bumpySheet(int cells);

} // namespace patina
