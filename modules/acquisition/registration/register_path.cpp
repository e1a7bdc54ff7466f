#include "acquisition/registration/register_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "acquisition/registration/yielding_fit.h"

namespace patina {
namespace {

constexpr double kExpected = 1.5;      // times the noise: a larger rms says that it lies elsewhere
constexpr std::size_t kDeciding = 600; // points that decide between places
constexpr int kMoreFits = 3;
constexpr double kRound = 5e-3;  // of the points' radius: noise below it sees no curvature
constexpr double kBetter = 0.99; // of the cost: what is better by less is not told apart

double shareThatCounts(const PathFit& fit) {
  return static_cast<double>(std::count_if(fit.weights.begin(), fit.weights.end(),
                                           [](double w) { return w > 0; })) /
         static_cast<double>(fit.weights.size());
}

// For a comparison: beyond `far` a miss is as bad as any other.
double cappedCost(const PathFit& fit, double far) {
  double sum = 0;
  for (const Miss& miss : fit.misses) sum += std::min(miss.distance * miss.distance, far * far);
  return sum;
}

struct Places {
  std::vector<Vec3> points;
  std::vector<std::size_t> of; // by point, in `points`

  // Means of what each point has.
  std::vector<double> meansOf(const std::vector<double>& values) const {
    std::vector<double> means(values.empty() ? 0 : points.size(), 0), counts(means.size(), 0);
    for (std::size_t i = 0; i < values.size(); ++i)
      means[of[i]] += (values[i] - means[of[i]]) / ++counts[of[i]];
    return means;
  }
};

Places placesOf(const std::vector<Vec3>& points, const std::vector<std::size_t>& scan,
                double reach) {
  Places places;
  Vec3 first = Vec3::Zero();
  double count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& point = points[i];
    const bool begins = i > 0 && !scan.empty() && scan[i] != scan[i - 1];
    if (count == 0 || begins || !((point - first).norm() < reach)) {
      first = point;
      count = 0;
      places.points.push_back(Vec3::Zero());
    }
    places.points.back() += (point - places.points.back()) / ++count;
    places.of.push_back(places.points.size() - 1);
  }
  return places;
}

Registration registerPlaces(const SurfaceTarget& target, const std::vector<Vec3>& points,
                            const Pose& start, RegistrationOptions options, Progress& progress) {
  const Places places = placesOf(points, options.scan, options.place);
  std::vector<double> pressed = std::exchange(options.pressed, places.meansOf(options.pressed));
  const ScanForces forces(options.force, options.scan);
  options.force = places.meansOf(options.force);
  std::vector<std::size_t> scan(options.scan.empty() ? 0 : places.points.size());
  for (std::size_t i = 0; i < options.scan.size(); ++i) scan[places.of[i]] = options.scan[i];
  options.scan = std::move(scan);
  options.place = 0;
  Registration found = registerPath(target, places.points, start, options, progress);
  if (forces.scans() > 0) pressed = forces.pressed(found.compliances);
  std::vector<Miss> misses;
  std::vector<bool> counts;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t place = places.of[i];
    misses.push_back(target.miss(found.mesh_from_path * points[i], found.misses[place].foot.face));
    if (!pressed.empty()) misses.back().distance += pressed[i];
    counts.push_back(found.counts[place]);
  }
  found.together *= // counted in places
      static_cast<double>(points.size()) / static_cast<double>(places.points.size());
  found.misses = std::move(misses);
  found.counts = std::move(counts);
  return found;
}

// Noise leads away from what is round: the mean distance of points about a place on a surface of
// mean curvature H is noise^2 H (the distance's Laplacian), and the fit moves the path by it. The
// mean is taken over six points that stand for a normal noise to the third degree. Asks
// for a target with sides.
PathFit fitLessBias(const SurfaceTarget& target, const std::vector<Vec3>& points, PathFit best,
                    const FitOptions& fitting, double noise) {
  std::vector<double> bias(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (best.weights[i] == 0) continue;
    const Miss& miss = best.misses[i];
    const Vec3 place = miss.at + target.offset() * miss.direction;
    for (int k = 0; k < 6; ++k) {
      const Vec3 aside = (k % 2 ? 1 : -1) * std::sqrt(3.) * noise * Vec3::Unit(k / 2);
      bias[i] += target.miss(place + aside, miss.foot.face).distance / 6;
    }
  }
  FitOptions unbiased = fitting;
  unbiased.pressed.resize(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) unbiased.pressed[i] -= bias[i];
  const int iterations = best.iterations;
  PathFit fit = fitPath(target, points, best.mesh_from_path, unbiased);
  fit.iterations += iterations;
  for (std::size_t i = 0; i < points.size(); ++i) fit.misses[i].distance += bias[i];
  return fit;
}

} // namespace

double leastNoise(const std::vector<Vec3>& points, double noise) {
  return std::max(noise, 1e-4 * scaleOf(points, Pose::Identity()).radius);
}

bool isExplained(double rms, double share, double noise, double least, double outliers) {
  return share >= 1 - outliers && (noise <= 0 || rms <= kExpected * least);
}

Registration registerPath(const SurfaceTarget& target, const std::vector<Vec3>& points,
                          const Pose& start, const RegistrationOptions& options,
                          Progress& progress) {
  if (!options.pressed.empty() && options.pressed.size() != points.size())
    throw std::invalid_argument("registerPath: a depth for each point, or none");
  if (!options.force.empty() && (options.force.size() != points.size() || !options.pressed.empty()))
    throw std::invalid_argument("registerPath: a force for each point and no depth, or none");
  if (!options.scan.empty() && options.scan.size() != points.size())
    throw std::invalid_argument("registerPath: a scan's number for each point, or none");
  if (options.place > 0) return registerPlaces(target, points, start, options, progress);
  const double least = leastNoise(points, options.noise);
  // Whether it lies where it should; without a noise only a fit without any does.
  const auto isGood = [&](const PathFit& fit) {
    return isExplained(fit.rms, shareThatCounts(fit), least, least, options.outliers);
  };
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
  fitting.noise = options.robust ? least : 0;
  if (options.robust && !isGood(best)) best = fitFrom(start, points);
  const bool anywhere = !(options.around.turn < std::numbers::pi);
  if (options.search && !isGood(best) && !(options.rivals && anywhere)) {
    progress.report(0.2, "search");
    const double far = 4 * std::max(options.noise, 10 * leastNoise(points, 0));
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
  const auto noiseOf = [&](const PathFit& fit) { return std::max(fit.rms, least); };
  ErrorLaw law;
  FreeMotions free;
  FitOptions yielding = fitting; // with the depths that were found for `best`
  const ScanForces forces(options.force, options.scan, options.expected);
  const auto judge = [&] {
    law = errorLaw(points, best, noiseOf(best), forces);
    if (forces.scans() > 0) {
      YieldingFit found = fitYielding(target, points, forces, best, law.together, fitting);
      best = std::move(found.fit);
      result.compliances = found.compliances;
      law = errorLaw(points, best, noiseOf(best), forces);
      yielding.pressed = forces.pressed(result.compliances);
    }
    free = freeMotions(target, points, best, noiseOf(best), law.together, yielding.pressed);
    addUnknown(free, law, scaleOf(points, best.mesh_from_path));
  };
  judge();
  if (options.rivals) {
    progress.report(0.5, "other places");
    // A first guess decides among places that cannot be told apart.
    const double better = anywhere ? 0 : kToldApart;
    std::vector<Pose> places =
        placesAllOver(target, points, best.mesh_from_path, yielding, progress);
    for (int round = 0;; ++round) {
      result.rivals = rivalsOf(target, points, places, best, yielding, law, free, progress);
      result.starts += static_cast<int>(places.size());
      if (round == 3 || result.rivals->empty() || result.rivals->front().better <= 0) break;
      places.push_back(best.mesh_from_path);
      const PathFit here = best;
      best = fitFrom(result.rivals->front().mesh_from_path, points);
      judge();
      // By the errors of the better place: at a wrong one a misfit passes for errors that go
      // together, by which no place could be told from another.
      const double gain = costOf(here.misses, law) - costOf(best.misses, law);
      if (gain > (isNear(here.mesh_from_path, best.mesh_from_path, points) ? 0 : better)) continue;
      best = here;
      judge();
      break;
    }
  }
  // A long flat valley takes more steps than one fit has.
  for (int again = 0; again < kMoreFits && !best.converged; ++again) {
    best = fitFrom(best.mesh_from_path, points);
    judge();
  }
  if (target.hasSides() && options.noise > kRound * scaleOf(points, best.mesh_from_path).radius)
    best = fitLessBias(target, points, std::move(best), yielding, std::min(best.rms, least));
  const MotionScale scale = scaleOf(points, best.mesh_from_path);
  result.mesh_from_path = best.mesh_from_path;
  result.rms = best.rms;
  result.noise = noiseOf(best);
  result.together = law.together;
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < best.misses.size(); ++i) {
    result.counts.push_back(best.weights[i] > 0);
    if (best.weights[i] == 0) continue;
    sum += std::abs(best.misses[i].distance);
    ++n;
  }
  result.mean_distance = sum / std::max(n, 1.0);
  result.covariance = law.covariance(free.basis);
  result.covariance.topRows<3>() /= scale.radius;
  result.covariance.leftCols<3>() /= scale.radius;
  result.free = std::move(free.named);
  result.middle = scale.centre;
  result.last_turn = best.last_turn;
  result.last_shift = best.last_shift;
  result.converged =
      best.converged && isExplained(best.rms, shareThatCounts(best), options.noise,
                                    std::hypot(least, options.roughness), options.outliers);
  if (options.noise > 0)
    result.roughness = std::sqrt(std::max(0., best.rms * best.rms - least * least));
  result.misses = std::move(best.misses);
  return result;
}

} // namespace patina
