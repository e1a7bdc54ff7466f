// Scans find their place on a mesh: what `patina register`, the desk Align and the demo run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquisition/registration/joint_fit.h"
#include "acquisition/registration/register_path.h"
#include "acquisition/texture/mesh_heights.h"

namespace patina {

struct ScanRegistrationOptions {
  // distance: least squares of the distances. loop: iterative closest points as Andrews and Lang
  // (2007) have it; literal: with their 4 x 4 matrix by least squares.
  enum class Method { distance, loop, literal } method = Method::distance;
  std::optional<Pose> guess; // of mesh_from_scan; absent: nothing is known of the place
  bool search = true; // tries other poses about the guess, and looks for other places on the mesh
  std::optional<double> noise; // of the samples, one deviation [m]; absent: what they state
  double roughness = 0.2e-3;   // the most that the surface's own relief may add to that [m]
  double outliers = 0.2;       // the share of the samples that may lie elsewhere than on the mesh
  std::optional<double> compliance; // of all scans [m/N]; absent: of each as the forces tell
  bool refine = false;              // fits the tip's place and the clocks' offset, too
};

struct RegisteredScans {
  Registration registration;      // of all samples, scan upon scan in an order of its own: see of()
  std::vector<std::size_t> first; // one a scan: its first sample in `registration`
  std::vector<std::vector<PathSample>> paths; // what took part, or as `joint` corrects it
  // What presses of a standing probe say of each scan's compliance, which that one then is; absent
  // without any.
  std::vector<std::optional<ComplianceEstimate>> presses;
  std::optional<JointFit> joint; // where it was asked for
  double noise = 0;              // that was expected of the samples [m]
  std::vector<std::string> warnings;
  std::vector<std::string> doubts; // of the mesh, see scanDoubts(): to be told with its name

  // What the registration says of one scan: its own misses, counts, rms and compliance, all else
  // of all.
  Registration of(std::size_t scan) const;
};

// The samples of a path that take part: those in contact (inContact()), no farther from the path's
// middle than twice the mesh's diagonal, unless most are. Appends a line to `warnings` for those
// that are so far.
std::vector<PathSample> touchingOn(const TriangleMesh& mesh, std::vector<PathSample> path,
                                   std::vector<std::string>& warnings);

// Scans of one body, the paths of which lie in one camera's frame; their order does not matter.
// touchingOn() says what takes part. `target` has sides. Throws Error where fewer than three
// samples of a scan take part, Cancelled.
RegisteredScans registerScans(const SurfaceTarget& target,
                              std::vector<std::vector<PathSample>> paths,
                              const ScanRegistrationOptions& options, Progress& progress);

} // namespace patina
