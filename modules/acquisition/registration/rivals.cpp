#include "acquisition/registration/rivals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/numbers.h"

namespace patina {
namespace {

constexpr std::size_t kRivalFew = 100, kMany = 400; // points that choose, and that decide
constexpr std::size_t kStarts = 6000, kGuesses = 100;
constexpr double kOnePlace = 0.05; // of the path's radius: fits as near as this are one
constexpr double kNear = 0.15;     // the same of one place that has several lowest points
constexpr double kDeviations = 3;  // deviations of a place: nearer it is the same
constexpr double kLeftOut = 9;     // squared deviations at which a point is left out
constexpr double kAlike = 0.8;     // of a cost: what is lower differs by more than chance
constexpr int kWay = 8;            // steps from one place to another

struct Some {
  std::vector<Vec3> points;
  std::vector<double> pressed;
};

Some someOf(const std::vector<Vec3>& points, const std::vector<double>& pressed,
            std::size_t count) {
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) finite.push_back(i);
  Some some;
  count = std::min(count, finite.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = finite[k * finite.size() / count];
    some.points.push_back(points[i]);
    if (!pressed.empty()) some.pressed.push_back(pressed[i]);
  }
  return some;
}

double between(const Pose& a, const Pose& b, const std::vector<Vec3>& points) {
  double squares = 0;
  for (const Vec3& p : points) squares += (a * p - b * p).squaredNorm();
  return std::sqrt(squares / static_cast<double>(points.size()));
}

// So many points stand for all.
double costOf(const PathFit& fit, const ErrorLaw& law, std::size_t all) {
  return costOf(fit.misses, law) * static_cast<double>(all) /
         static_cast<double>(fit.misses.size());
}

struct FoundFit {
  PathFit fit;
  double cost;
};

PathFit fitOf(const SurfaceTarget& target, const Some& some, const Pose& from,
              const FitOptions& fitting) {
  FitOptions options = fitting;
  options.iterations = 15;
  options.pressed = some.pressed;
  return fitPath(target, some.points, from, options);
}

std::vector<Miss> missesAt(const SurfaceTarget& target, const Some& some, const Pose& pose) {
  std::vector<Miss> misses;
  for (std::size_t i = 0; i < some.points.size(); ++i) {
    misses.push_back(target.miss(pose * some.points[i]));
    if (!some.pressed.empty()) misses.back().distance += some.pressed[i];
  }
  return misses;
}

// Whether the straight way from one pose to another is nowhere worse than its ends.
bool isOneValley(const SurfaceTarget& target, const Some& some, const Pose& from, const Pose& to,
                 const ErrorLaw& law, double most) {
  const Pose motion = to * from.inverse();
  const Eigen::AngleAxisd turn(motion.linear());
  // About the point that a screw's axis goes through, and along it.
  const Vec3 along = turn.axis() * turn.axis().dot(motion.translation());
  const Vec3 aside = motion.translation() - along;
  const double half = std::tan(turn.angle() / 2);
  const Vec3 through =
      half > 1e-6 ? Vec3(0.5 * (aside + turn.axis().cross(aside) / half)) : Vec3::Zero();
  for (int step = 1; step < kWay; ++step) {
    const double part = static_cast<double>(step) / kWay;
    Pose halfway = Pose::Identity();
    halfway.linear() = Eigen::AngleAxisd(part * turn.angle(), turn.axis()).toRotationMatrix();
    halfway.translation() = half > 1e-6 ? Vec3(through - halfway.linear() * through + part * along)
                                        : Vec3(part * motion.translation());
    if (costOf(missesAt(target, some, halfway * from), law) > most) return false;
  }
  return true;
}

} // namespace

std::string inWords(const std::vector<Rival>& rivals) {
  const Rival& farthest = *std::max_element(
      rivals.begin(), rivals.end(), [](const Rival& a, const Rival& b) { return a.away < b.away; });
  char turn[32];
  std::snprintf(turn, sizeof turn, "%.3g", farthest.turn * 180 / std::numbers::pi);
  const std::string away = formatLength(farthest.away) + " and " + turn + " degrees away";
  if (rivals.size() == 1) return "another place fits as well, " + away;
  return formatCount(rivals.size()) + " other places fit as well; the farthest is " + away;
}

double costOf(const std::vector<Miss>& misses, const ErrorLaw& law) {
  double sum = 0;
  for (const Miss& miss : misses) {
    const double deviations = miss.distance / law.deviation;
    sum += std::min(deviations * deviations, kLeftOut);
  }
  return sum / law.together;
}

bool isNear(const Pose& mesh_from_path, const Pose& other, const std::vector<Vec3>& points) {
  return between(mesh_from_path, other, points) < kNear * scaleOf(points, mesh_from_path).radius;
}

bool isOnePlace(const Pose& mesh_from_path, const Pose& other, const std::vector<Vec3>& points) {
  return between(mesh_from_path, other, points) <
         kOnePlace * scaleOf(points, mesh_from_path).radius;
}

std::vector<Pose> placesAllOver(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                const Pose& pose, const FitOptions& fitting, Progress& progress) {
  const MotionScale scale = scaleOf(points, pose);
  const Box3 box = bounds(target.mesh());
  Pose middle = pose;
  middle.translation() += box.center() - scale.centre;
  const Some few = someOf(points, fitting.pressed, kRivalFew);
  std::vector<Pose> places;
  for (const Pose& guess :
       coarsePoses(target, points, middle,
                   {std::numbers::pi, box.sizes().norm() / 2, kGuesses, kStarts}, progress)) {
    progress.throwIfCancelled();
    const Pose place = fitOf(target, few, guess, fitting).mesh_from_path;
    if (std::none_of(places.begin(), places.end(), [&](const Pose& other) {
          return between(other, place, few.points) < kOnePlace * scale.radius / 2;
        }))
      places.push_back(place);
  }
  return places;
}

std::vector<Rival> rivalsOf(const SurfaceTarget& target, const std::vector<Vec3>& points,
                            const std::vector<Pose>& places, const PathFit& best,
                            const FitOptions& fitting, const ErrorLaw& law, const FreeMotions& free,
                            Progress& progress) {
  const double radius = scaleOf(points, best.mesh_from_path).radius;
  const Some few = someOf(points, fitting.pressed, kRivalFew),
             many = someOf(points, fitting.pressed, kMany);
  const double same =
      std::max(kOnePlace * radius, kDeviations * std::sqrt(law.covariance(free.basis).trace()));
  const PathFit start = fitOf(target, many, best.mesh_from_path, fitting);
  const double here = costOf(start, law, points.size()), most = here + kToldApart;
  const double roughly = 2 * here + 4 * kToldApart; // as few points tell it
  std::vector<FoundFit> found;
  for (const Pose& place : places) {
    progress.throwIfCancelled();
    const double rough = costOf(missesAt(target, few, place), law) *
                         static_cast<double>(points.size()) /
                         static_cast<double>(few.points.size());
    if (rough > roughly) continue;
    PathFit fit = fitOf(target, many, place, fitting);
    const double cost = costOf(fit, law, points.size());
    if (cost > most) continue;
    const double away = between(fit.mesh_from_path, best.mesh_from_path, many.points);
    if (away < same && cost > here - 1e-2) continue;
    const auto twin = std::find_if(found.begin(), found.end(), [&](const FoundFit& other) {
      return between(other.fit.mesh_from_path, fit.mesh_from_path, many.points) < same;
    });
    if (twin == found.end())
      found.push_back({std::move(fit), cost});
    else if (cost < twin->cost)
      *twin = {std::move(fit), cost};
  }
  std::vector<Rival> rivals;
  std::sort(found.begin(), found.end(),
            [](const FoundFit& a, const FoundFit& b) { return a.cost < b.cost; });
  const double stands_for =
      static_cast<double>(points.size()) / static_cast<double>(many.points.size());
  for (const FoundFit& one : found) {
    // Along what is free the ends differ by chance, and nothing between them is worse than that.
    if (one.cost > here && isNear(best.mesh_from_path, one.fit.mesh_from_path, many.points) &&
        isOneValley(target, many, best.mesh_from_path, one.fit.mesh_from_path, law,
                    (one.cost + kToldApart) / stands_for))
      continue;
    const double chance = 1.25 * std::max(one.cost, here) + kToldApart;
    if (free.basis.cols() > 0 && one.cost > std::max(here - kToldApart, kAlike * here) &&
        isOneValley(target, many, best.mesh_from_path, one.fit.mesh_from_path, law,
                    chance / stands_for))
      continue;
    const Pose& pose = one.fit.mesh_from_path;
    const auto counts = static_cast<double>(std::count_if(
        one.fit.weights.begin(), one.fit.weights.end(), [](double w) { return w > 0; }));
    rivals.push_back(
        {pose, one.fit.rms,
         static_cast<std::size_t>(std::lround(counts * static_cast<double>(points.size()) /
                                              static_cast<double>(many.points.size()))),
         between(pose, best.mesh_from_path, many.points),
         Eigen::AngleAxisd((pose * best.mesh_from_path.inverse()).linear()).angle(),
         here - one.cost});
  }
  return rivals;
}

} // namespace patina
