#include "acquisition/registration/register_path.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace patina {
namespace {

constexpr double kExpected = 1.5;      // times the noise: a larger rms says that it lies elsewhere
constexpr std::size_t kDeciding = 600; // points that decide between places
constexpr double kEnough = 0.6;        // of the points must count
constexpr double kBetter = 0.99;       // of the cost: what is better by less is not told apart

double shareThatCounts(const PathFit& fit) {
  return static_cast<double>(std::count_if(fit.weights.begin(), fit.weights.end(),
                                           [](double w) { return w > 0; })) /
         static_cast<double>(fit.weights.size());
}

// A fit as close as `good` [m] lies where it should.
bool isGood(const PathFit& fit, double good) {
  return fit.rms <= good && shareThatCounts(fit) >= kEnough;
}

// For a comparison: beyond `far` a miss is as bad as any other.
double cappedCost(const PathFit& fit, double far) {
  double sum = 0;
  for (const Miss& miss : fit.misses) sum += std::min(miss.distance * miss.distance, far * far);
  return sum;
}

Mat6 covarianceOf(const PathFit& fit, const MotionScale& scale, double noise,
                  const FreeMotions& free) {
  const Eigen::SelfAdjointEigenSolver<Mat6> eigen(fit.normal);
  Mat6 covariance = Mat6::Zero();
  for (int k = 0; k < 6; ++k) {
    const Vec6 v = eigen.eigenvectors().col(k);
    if ((free.basis.transpose() * v).norm() < 0.5)
      covariance += noise * noise / eigen.eigenvalues()[k] * v * v.transpose();
  }
  covariance.topRows<3>() /= scale.radius;
  covariance.leftCols<3>() /= scale.radius;
  return covariance;
}

struct Places {
  std::vector<Vec3> points;
  std::vector<double> pressed;
  std::vector<std::size_t> of; // by point, in `points`
};

Places placesOf(const std::vector<Vec3>& points, const std::vector<double>& pressed, double reach) {
  Places places;
  Vec3 first = Vec3::Zero();
  double count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (count == 0 || !((points[i] - first).norm() < reach)) {
      first = points[i];
      count = 0;
      places.points.push_back(Vec3::Zero());
      if (!pressed.empty()) places.pressed.push_back(0);
    }
    ++count;
    places.points.back() += (points[i] - places.points.back()) / count;
    if (!pressed.empty()) places.pressed.back() += (pressed[i] - places.pressed.back()) / count;
    places.of.push_back(places.points.size() - 1);
  }
  return places;
}

Registration registerPlaces(const SurfaceTarget& target, const std::vector<Vec3>& points,
                            const Pose& start, RegistrationOptions options, Progress& progress) {
  Places places = placesOf(points, options.pressed, options.place);
  const std::vector<double> pressed = std::exchange(options.pressed, std::move(places.pressed));
  options.place = 0;
  Registration found = registerPath(target, places.points, start, options, progress);
  std::vector<Miss> misses;
  std::vector<bool> counts;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t place = places.of[i];
    misses.push_back(target.miss(found.mesh_from_path * points[i], found.misses[place].foot.face));
    if (!pressed.empty()) misses.back().distance += pressed[i];
    counts.push_back(found.counts[place]);
  }
  found.misses = std::move(misses);
  found.counts = std::move(counts);
  return found;
}

} // namespace

Registration registerPath(const SurfaceTarget& target, const std::vector<Vec3>& points,
                          const Pose& start, const RegistrationOptions& options,
                          Progress& progress) {
  if (!options.pressed.empty() && options.pressed.size() != points.size())
    throw std::invalid_argument("registerPath: a depth for each point, or none");
  if (options.place > 0) return registerPlaces(target, points, start, options, progress);
  const double extent = scaleOf(points, start).radius;
  const double floor = 1e-4 * extent;
  const double good = kExpected * std::max(options.noise, floor);
  FitOptions fitting;
  fitting.pressed = options.pressed;
  Registration result;
  result.starts = 0;
  const auto fitFrom = [&](const Pose& from, const std::vector<Vec3>& some) {
    PathFit fit = fitPath(target, some, from, fitting);
    ++result.starts;
    result.iterations += fit.iterations;
    result.evaluations += fit.evaluations;
    return fit;
  };
  progress.report(0, "fit");
  PathFit best = fitFrom(start, points); // where nothing is amiss, all that it takes
  fitting.noise = options.robust ? std::max(options.noise, floor) : 0;
  if (options.robust && !isGood(best, good)) best = fitFrom(start, points);
  if (options.search && !isGood(best, good)) {
    progress.report(0.2, "search");
    const double far = 4 * std::max(options.noise, 10 * floor);
    const std::vector<Pose> guesses = coarsePoses(target, points, start, options.around, progress);
    // Which of them is the place shows on a part of the points.
    std::vector<Vec3> few;
    std::vector<double> few_pressed;
    const std::size_t step = points.size() / kDeciding + 1;
    for (std::size_t i = 0; i < points.size(); i += step) {
      while (i + 1 < points.size() && !points[i].allFinite()) ++i;
      few.push_back(points[i]);
      if (!options.pressed.empty()) few_pressed.push_back(options.pressed[i]);
    }
    std::swap(fitting.pressed, few_pressed);
    PathFit nearest = fitFrom(best.mesh_from_path, few);
    for (const Pose& guess : guesses) {
      progress.throwIfCancelled();
      PathFit fit = fitFrom(guess, few);
      if (cappedCost(fit, far) < kBetter * cappedCost(nearest, far)) nearest = std::move(fit);
    }
    std::swap(fitting.pressed, few_pressed);
    best = fitFrom(nearest.mesh_from_path, points);
  }
  const MotionScale scale = scaleOf(points, best.mesh_from_path);
  result.mesh_from_path = best.mesh_from_path;
  result.rms = best.rms;
  result.noise = std::max({best.rms, options.noise, floor});
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < best.misses.size(); ++i) {
    result.counts.push_back(best.weights[i] > 0);
    if (best.weights[i] == 0) continue;
    sum += std::abs(best.misses[i].distance);
    ++n;
  }
  result.mean_distance = sum / std::max(n, 1.0);
  FreeMotions free = freeMotions(target, points, best, result.noise, options.pressed);
  result.covariance = covarianceOf(best, scale, std::sqrt(sharing(best)) * result.noise, free);
  result.free = std::move(free.named);
  result.middle = scale.centre;
  result.last_turn = best.last_turn;
  result.last_shift = best.last_shift;
  result.converged = best.converged &&
                     (options.noise <= 0 ? shareThatCounts(best) >= kEnough : isGood(best, good));
  result.misses = std::move(best.misses);
  return result;
}

} // namespace patina
