// Where else on its mesh a path lies as well as at its best place (A29): a shape that is alike in
// several places, or a path so short that it fits many.
#pragma once

#include "acquisition/registration/coarse_search.h"
#include "acquisition/registration/error_law.h"
#include "acquisition/registration/free_motions.h"

namespace patina {

struct Rival {
  Pose mesh_from_path = Pose::Identity();
  double rms = 0;            // of what counts there [m]
  std::size_t counts = 0;    // points
  double away = 0, turn = 0; // from the best place: of the points, rms [m], and turned [rad]
  double better = 0;         // by so much its cost is lower than the best place's
};

// "3 other places fit as well; the farthest is 8.04 mm and 58.2 degrees away". Not empty.
std::string inWords(const std::vector<Rival>& rivals);

// Of the fit, as rivals are judged: squared misses in deviations, no point worse than one that is
// left out, over the number of points that are worth one.
double costOf(const std::vector<Miss>& misses, const ErrorLaw& law);

// Two fits whose costs differ by less cannot be told apart: the 99 % quantile of chi squared with
// the six freedoms of a pose, which bounds twice the difference of their log likelihoods.
constexpr double kToldApart = 16.81;

// Whether the points lie nearly as at the other pose, to a twentieth of the path's radius.
bool isOnePlace(const Pose& mesh_from_path, const Pose& other, const std::vector<Vec3>& points);

// The same to a seventh of it: one place, which may have several lowest points.
bool isNear(const Pose& mesh_from_path, const Pose& other, const std::vector<Vec3>& points);

// Poses all over the mesh at which a part of the path fits best nearby; the same ones each time.
// Throws Cancelled.
std::vector<Pose> placesAllOver(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                const Pose& pose, const FitOptions& fitting, Progress& progress);

// Fits from these places that cannot be told from `best`, or are better; the best first. What
// `free` motions lead to is no other place. `fitting` is that of `best`. Throws Cancelled.
std::vector<Rival> rivalsOf(const SurfaceTarget& target, const std::vector<Vec3>& points,
                            const std::vector<Pose>& places, const PathFit& best,
                            const FitOptions& fitting, const ErrorLaw& law, const FreeMotions& free,
                            Progress& progress);

} // namespace patina
