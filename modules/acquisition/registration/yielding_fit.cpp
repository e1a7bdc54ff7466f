#include "acquisition/registration/yielding_fit.h"

#include <algorithm>
#include <cmath>

#include "core/decompose.h"

namespace patina {
namespace {

constexpr int kYieldRounds = 6;
constexpr double kStill = 1e-2; // of rms / sqrt(n): a depth that changes by less is found

} // namespace

double usualForce(const std::vector<double>& force) {
  double squares = 0;
  for (const double f : force) squares += f * f;
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, force.size())));
}

YieldingFit fitYielding(const SurfaceTarget& target, const std::vector<Vec3>& points,
                        const std::vector<double>& force, const PathFit& hard, double together,
                        const FitOptions& options) {
  using Vec7 = Eigen::Matrix<double, 7, 1>;
  using Mat7 = Eigen::Matrix<double, 7, 7>;
  const double usual = usualForce(force);
  YieldingFit found{hard, 0};
  double depth = 0; // at the usual force [m]
  for (int round = 0; round < kYieldRounds && usual > 0; ++round) {
    const MotionScale scale = scaleOf(points, found.fit.mesh_from_path);
    Mat7 normal = Mat7::Zero();
    Vec7 right = Vec7::Zero();
    double counting = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (found.fit.weights[i] == 0) continue;
      Vec7 g;
      g << scale.gradient(found.fit.mesh_from_path * points[i], found.fit.misses[i].direction),
          force[i] / usual;
      normal.selfadjointView<Eigen::Lower>().rankUpdate(g);
      right -= found.fit.misses[i].distance * g;
      ++counting;
    }
    const double known = kYields * usual;
    const double weight = found.fit.rms * found.fit.rms * together / (known * known);
    normal(6, 6) += weight;
    right[6] -= weight * depth;
    const SymmetricEigen eigen(normal); // reads the lower half
    Vec7 step = Vec7::Zero();
    for (int k = 0; k < 7; ++k)
      if (eigen.values[k] > kBlind * eigen.values[6])
        step += eigen.vectors.col(k) * eigen.vectors.col(k).dot(right) / eigen.values[k];
    const double before = depth;
    depth = std::max(0., depth + step[6]);
    Vec6 motion = step.head<6>();
    limit(motion, scale, target.extent());
    FitOptions fitting = options;
    fitting.pressed.clear();
    for (const double f : force) fitting.pressed.push_back(depth * f / usual);
    const int iterations = found.fit.iterations;
    const std::size_t evaluations = found.fit.evaluations;
    found.fit = fitPath(target, points, scale.motion(motion) * found.fit.mesh_from_path, fitting);
    found.fit.iterations += iterations;
    found.fit.evaluations += evaluations;
    found.compliance = depth / usual;
    if (std::abs(depth - before) < kStill * found.fit.rms / std::sqrt(std::max(counting, 1.)))
      break;
  }
  return found;
}

} // namespace patina
