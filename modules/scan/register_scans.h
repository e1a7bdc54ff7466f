// Registers scans to a mesh; used by `patina register`, the Align page and the demo.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquisition/registration/joint_fit.h"
#include "acquisition/registration/register_path.h"
#include "acquisition/texture/mesh_heights.h"

namespace patina {

struct ScanRegistrationOptions {
  // distance: least squares of the distances. loop: ICP (Besl & McKay 1992) as in Andrews & Lang
  // (2007); literal: with their 4 x 4 matrix by least squares.
  enum class Method { distance, loop, literal } method = Method::distance;
  std::optional<Pose> guess;   // mesh_from_scan; absent: no initial pose
  bool search = true;          // also tries other poses near the guess and on the whole mesh
  std::optional<double> noise; // standard deviation of the samples [m]; absent: their own
  double roughness = 0.2e-3;   // max height of the surface's own relief, added to the noise [m]
  double outliers = 0.2;       // max share of the samples that may not lie on the mesh
  // Compliance of all scans [m/N]; absent: estimated per scan from the forces.
  std::optional<double> compliance;
  bool refine = false;            // also fits the tip's position and the clock offset
  std::vector<std::string> names; // names of the scans in warnings and errors; may be empty
};

struct RegisteredScans {
  Registration registration;                  // all samples, in the scans' sorted order: see of()
  std::vector<std::size_t> first;             // per scan, its first sample in `registration`
  std::vector<std::vector<PathSample>> paths; // samples used, corrected by `joint` if present
  // Compliance of each scan estimated from presses of a standing probe, which then applies; absent
  // without presses.
  std::vector<std::optional<ComplianceEstimate>> presses;
  std::optional<JointFit> joint; // if requested
  double noise = 0;              // expected deviation of the samples [m]
  std::vector<std::string> warnings;
  std::vector<std::string> doubts; // about the mesh, see scanDoubts(); the caller adds its name

  // Result of one scan: its own residuals, inliers, rms and compliance; the rest is common to all.
  Registration of(std::size_t scan) const;
};

// Returns the samples to register: those in contact (inContact()) and within two mesh diagonals of
// the path's middle, unless most are farther. Appends a line to `warnings` for samples that are too
// far.
std::vector<PathSample> touchingOn(const TriangleMesh& mesh, std::vector<PathSample> path,
                                   std::vector<std::string>& warnings);

// Registers scans of one body whose paths are in the same camera frame; their order does not
// matter. touchingOn() selects the samples. `target` must have sides. Throws Cancelled, and Error
// (FileError if the scans have names) if a scan has fewer than three such samples.
RegisteredScans registerScans(const SurfaceTarget& target,
                              std::vector<std::vector<PathSample>> paths,
                              const ScanRegistrationOptions& options, Progress& progress);

// Returns the lines of `warnings` and `doubts`, and why the pose may be ambiguous.
std::vector<std::string> warningsOf(const RegisteredScans& found, const std::string& mesh);

} // namespace patina
