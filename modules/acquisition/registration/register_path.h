// Registers a path to a mesh (A10): local fit, search, inliers and unobservable motions.
#pragma once

#include "acquisition/registration/coarse_search.h"
#include "acquisition/registration/compliance_fit.h"
#include "acquisition/registration/residual_noise.h"
#include "acquisition/registration/unobservable_motions.h"

namespace patina {

// Alternative poses of a path on its mesh that fit as well as the best one (A29): the shape repeats
// itself, or the path is so short that it fits in many places.
struct AlternativePose {
  Pose mesh_from_path = Pose::Identity();
  double rms = 0;          // rms distance of the inliers [m]
  std::size_t inliers = 0; // number of inliers
  double displacement = 0,
         rotation = 0;  // rms displacement [m] and rotation [rad] from the best pose
  double cost_gain = 0; // cost of the best pose minus this one's
};

// Returns "3 other places fit as well; the farthest is 8.04 mm and 58.2 degrees away".
std::string inWords(const std::vector<AlternativePose>& alternatives);

// Returns the truncated cost of a fit: squared residuals in standard deviations, capped at the
// outlier threshold, divided by the number of correlated samples per independent one.
double costOf(const std::vector<SurfaceResidual>& residuals, const ResidualNoiseModel& law);

// Likelihood-ratio test: fits whose costs differ by less are indistinguishable. It is the 99 %
// quantile of chi squared with the six degrees of freedom of a pose.
constexpr double kChi2Quantile6 = 16.81;

// Returns true if the points lie within a twentieth of the path's radius of the other pose.
bool isSamePose(const Pose& mesh_from_path, const Pose& other, const std::vector<Vec3>& points);

// The same within a seventh of it: local minima of one pose.
bool isNear(const Pose& mesh_from_path, const Pose& other, const std::vector<Vec3>& points);

// Returns local optima of a global, deterministic search with a part of the path. Throws Cancelled.
std::vector<Pose> globalCandidates(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                   const Pose& pose, const FitOptions& fitting, Progress& progress);

// Returns the fits from these start poses that are as likely as `best` or better, the best first.
// Poses that differ by `free` motions are the same. `fitting` is that of `best`. Throws Cancelled.
std::vector<AlternativePose> alternativePoses(const SurfaceTarget& target,
                                              const std::vector<Vec3>& points,
                                              const std::vector<Pose>& places, const PathFit& best,
                                              const FitOptions& fitting,
                                              const ResidualNoiseModel& law,
                                              const UnobservableMotions& free, Progress& progress);

struct RegistrationOptions {
  double noise = 0;                 // deviation of the points [m]; 0: unknown, assumes an exact fit
  double roughness = 0;             // largest additional deviation, by texture [m]
  double outliers = 0.4;            // largest accepted share of outliers
  std::vector<double> indentations; // see FitOptions
  std::vector<double> force;        // one per point [N]; fits compliances, needs sides
  std::vector<ExpectedCompliance> expected; // with `force`: one per scan, or empty
  std::vector<std::size_t> scan;            // scan number from 0; empty: a single scan
  bool robust = true;                       // detects outliers; else all points are inliers
  bool search = true;          // if the fit from `start` is not consistent with the noise
  CoarseSearch search_options; // search options; `rotation` of pi: the pose is unknown
  bool alternatives = false;   // searches the whole mesh, for about half a second
  // Consecutive points within this distance of the first of them are averaged, so that a stationary
  // probe has no more weight than a moving one; 0: each point counts [m].
  double sample_spacing = 0;
};

struct Registration {
  Pose mesh_from_path = Pose::Identity();
  double mean_distance = 0, rms = 0; // residuals of the inliers [m]
  // Covariance of a small rotation about the path's center [rad], then of its translation [m], in
  // the mesh's frame; unobservable directions add nothing. Correlated errors of neighbouring
  // samples are accounted for (ResidualNoiseModel).
  Mat6 covariance = Mat6::Zero();
  Vec3 middle = Vec3::Zero();           // [m]
  std::vector<UnobservableMotion> free; // the path keeps its start pose along these
  // Equally likely poses, the best first; nullopt: not searched.
  std::optional<std::vector<AlternativePose>> alternatives;
  std::vector<SurfaceResidual> residuals; // one per point
  std::vector<bool> inliers;              // inlier flag of each point
  double noise = 0;                       // deviation shown by the fit [m]
  double roughness = 0;                   // part of it that the given noise does not explain [m]
  // One per scan, if estimated from `force`, with their standard deviations [m/N].
  std::vector<double> compliances, compliance_deviations;
  double correlation_length = 1;                  // correlated samples per independent one
  double last_rotation = 0, last_translation = 0; // last step [rad, m]
  int iterations = 0, starts = 1;
  std::size_t evaluations = 0; // number of distance queries
  // True if neither residuals nor pose changed any more, most points are inliers, and the given
  // noise and the permitted roughness explain the rms.
  bool converged = false;
};

// Returns the expected rms displacement of the path's points by the error of the pose (1 sigma)
// [m], one length for all its observable directions together; those that are free add nothing.
double pathDeviation(const Registration& found);

// Returns true if the fit is inconsistent with the noise, or ambiguous.
inline bool isUnreliable(const Registration& found) {
  return !found.converged || (found.alternatives && !found.alternatives->empty());
}

// Acceptance of a pose: the smallest noise assumed for the points [m], and whether all points but a
// share of `outliers` are inliers that are consistent with the noise, if it is given.
double minNoise(const std::vector<Vec3>& points, double noise);
bool isConsistentWithNoise(double rms, double share, double noise, double least, double outliers);

// Throws std::invalid_argument if no point is finite or the sizes of `indentations`, `force` or
// `scan` differ from the number of points; Cancelled.
Registration registerPath(const SurfaceTarget& target, const std::vector<Vec3>& points,
                          const Pose& start, const RegistrationOptions& options,
                          Progress& progress);

} // namespace patina
