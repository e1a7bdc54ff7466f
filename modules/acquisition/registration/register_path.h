// A path finds its place on a mesh (A10): the nearest good fit, a search where that is none, what
// counts, and what stays unknown.
#pragma once

#include "acquisition/registration/coarse_search.h"
#include "acquisition/registration/free_motions.h"
#include "acquisition/registration/rivals.h"
#include "acquisition/registration/yielding_fit.h"

namespace patina {

struct RegistrationOptions {
  // Deviation of the points [m]; 0: unknown, and only a fit without any is trusted without a
  // search.
  double noise = 0;
  // The most that the surface's own relief may add to it [m]: texture is what a scan is for.
  double roughness = 0;
  double outliers = 0.4;       // the share of the points that may lie elsewhere
  std::vector<double> pressed; // see FitOptions
  std::vector<double> force;   // one a point [N]: how far the surface yields is found, too;
                               // `pressed` is empty then. Asks for a target with sides
  std::vector<ExpectedCompliance> expected; // with `force`: one a scan, or empty
  std::vector<std::size_t> scan; // with `force`: the number of each point's scan, from 0, each of
                                 // which has a compliance of its own; empty: all are of one
  bool robust = true;            // finds what counts; else all points do
  bool search = true;  // where the fit from `start` is not as good as the noise lets expect
  CoarseSearch around; // how; `turn` of pi: nothing is known of the place
  bool rivals = false; // looks all over the mesh for other places, half a second or so
  // Points in a row that lie within this of the first of them are one place, their mean, so that
  // where the probe stood counts no more than where it passed; 0: each point counts [m].
  double place = 0;
};

struct Registration {
  Pose mesh_from_path = Pose::Identity();
  double mean_distance = 0, rms = 0; // of what counts, from where it should be [m]
  // Of a small turn about the path's middle [rad], then of its shift [m], in the mesh's frame; what
  // is free adds nothing. Errors that neighbouring samples share count once (ErrorLaw).
  Mat6 covariance = Mat6::Zero();
  Vec3 middle = Vec3::Zero();   // [m]
  std::vector<FreeMotion> free; // the path stays where it was in these
  // Places that cannot be told from this one, the best first; nullopt: nobody looked.
  std::optional<std::vector<Rival>> rivals;
  std::vector<Miss> misses; // one a point
  std::vector<bool> counts; // one a point
  double noise = 0;         // that the fit shows [m]
  double roughness = 0; // what of it the samples' noise leaves unexplained, where that was told [m]
  std::vector<double> compliances;      // one a scan, where `force` let them be found [m/N]
  double together = 1;                  // so many samples in a row are worth one
  double last_turn = 0, last_shift = 0; // of the last step [rad, m]
  int iterations = 0, starts = 1;
  std::size_t evaluations = 0; // of a point's distance
  // Neither residual nor pose moved any more, most points count, and the noise, where it was told,
  // and as much roughness as may be explain the rms.
  bool converged = false;
};

// Not as good a fit as the noise lets expect, or one of several.
inline bool isDoubtful(const Registration& found) {
  return !found.converged || (found.rivals && !found.rivals->empty());
}

// What a place is judged by. The least noise that is taken for one, of points as they lie [m]; and
// whether all points but as many `outliers` count, and are as close as the noise lets expect, where
// that is told.
double leastNoise(const std::vector<Vec3>& points, double noise);
bool isExplained(double rms, double share, double noise, double least, double outliers);

// Throws std::invalid_argument: no finite point, `pressed`, `force` or `scan` of another number;
// Cancelled.
Registration registerPath(const SurfaceTarget& target, const std::vector<Vec3>& points,
                          const Pose& start, const RegistrationOptions& options,
                          Progress& progress);

} // namespace patina
