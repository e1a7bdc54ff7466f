// Knowledge gained by a scan so far, and the stroke that would add most to it (optimal design of
// experiments).
#pragma once

#include <optional>

#include "acquisition/registration/register_path.h"

namespace patina {

// One independent measurement of the surface, in the mesh's frame.
struct SurfaceMeasurement {
  Vec3 point = Vec3::Zero();      // on the mesh [m]
  Vec3 direction = Vec3::UnitZ(); // unit; in it the pose's error shifts the measured distance
  double deviation = 0;           // deviation of the distance, for the pose [m]
  double height_deviation = 0;    // deviation of the surface's height [m]
};

// Returns the inliers of a registration, in order. Errors of neighbours are correlated: only one in
// `correlation_length` counts. `height_deviation` [m]: of single samples, without roughness.
std::vector<SurfaceMeasurement> measurementsOf(const Registration& registration,
                                               double height_deviation);

struct ScanGoal {
  double pose = 0.1e-3;   // deviation of the pose: rms displacement of the mesh [m]
  double height = 0.2e-3; // deviation of the heights [m] ...
  double area = 0.95;     // ... over this share of the area
  // Radius within which measurements contribute to a height, with the weight (1 - (d/radius)^2)^2
  // of their distance d; 0: 3 % of the mesh's extent [m].
  double radius = 0;
  std::vector<bool> reachable; // per face, whether the hand can reach it; empty: all
};

// A motion of the scan over the mesh, by one standard deviation.
struct PoseUncertainty {
  Vec3 rotation = Vec3::Zero(), translation = Vec3::Zero(); // about ScanKnowledge::centre [rad, m]
  double displacement = 0;                                  // rms, of the mesh [m]
};

struct ScanKnowledge {
  std::vector<float> height_deviation; // per vertex [m]; infinite without a measurement nearby
  double area = 0;                     // share of the reachable area that meets the goal
  double pose = 0;                     // rms displacement of the mesh, one deviation [m]
  Vec3 centre = Vec3::Zero();          // centre of the area [m]
  Mat6 covariance =
      Mat6::Zero(); // covariance of a small rotation about it [rad] and a translation [m]
  // Principal motions: uncorrelated, the least known first. Before any measurement each rotation
  // counts as known to half a radian and each translation to half the mesh's extent.
  std::vector<PoseUncertainty> motions;
  bool complete = false; // meets the goal
};

struct ScanStroke {
  std::vector<Vec3> points;  // on the mesh, evenly spaced [m]
  double pose = 0, area = 0; // expected after it, as in ScanKnowledge
};

struct StrokeOptions {
  double length = 0.05;             // length over the mesh [m]
  double spacing = 2e-3;            // spacing of its independent measurements [m]
  double deviation = 0.3e-3;        // deviation of their distances, for the pose [m]
  double height_deviation = 0.3e-3; // deviation of their heights [m]
  int starts = 48, directions = 4;  // number of candidates
  std::uint32_t seed = 1;
};

// Returns the options that continue a registered path as it was scanned: spacing and deviations are
// medians of its own measurements.
StrokeOptions strokeOptionsFor(const std::vector<SurfaceMeasurement>& measurements);

ScanKnowledge knowledgeOf(const SurfaceTarget& target,
                          const std::vector<SurfaceMeasurement>& measurements,
                          const ScanGoal& goal);

// Returns the candidate stroke of the largest gain, nullopt if the goal is met or nothing can be
// reached. The gain is the share of the way to the goal: of the logarithm of the pose's deviation,
// whose square is the trace of the covariance over the mesh (Bayesian A-optimality, Chaloner &
// Verdinelli 1995) with the information of point-to-plane distances added, plus that of the
// information that heights still lack. Candidates begin where it is lacking and run straight on.
// Deterministic. Throws std::invalid_argument for options that are not positive, or if
// `reachable` has another size than the faces.
std::optional<ScanStroke> nextStroke(const SurfaceTarget& target,
                                     const std::vector<SurfaceMeasurement>& measurements,
                                     const ScanGoal& goal, const StrokeOptions& options);

// Returns the points of a stroke over the mesh: straight on from `start` to both sides along
// `direction`, as far as the surface goes without a crease above 60 degrees, at most `length`.
std::vector<Vec3> strokeOver(const SurfaceTarget& target, const Vec3& start, const Vec3& direction,
                             double length, double spacing);

} // namespace patina
