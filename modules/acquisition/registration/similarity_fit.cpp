#include "acquisition/registration/similarity_fit.h"

#include <cmath>

#include "core/decompose.h"

namespace patina {
namespace {

constexpr int kSteps = 30;
constexpr double kSettledScale = 1e-4;
constexpr double kMostStep = 0.1; // of the scale's logarithm

} // namespace

SimilarityFit fitSimilarity(const SurfaceTarget& target, const std::vector<Vec3>& points,
                            const Pose& mesh_from_path, const std::vector<bool>& counts,
                            const std::vector<double>& pressed, double noise) {
  using Vec7 = Eigen::Matrix<double, 7, 1>;
  using Mat7 = Eigen::Matrix<double, 7, 7>;
  const MotionScale whole = scaleOf(points, Pose::Identity());
  SimilarityFit fit;
  fit.mesh_from_path = mesh_from_path;
  std::vector<Vec3> scaled = points;
  PathFit left; // what this fit leaves
  left.misses.resize(points.size());
  for (const bool count : counts) left.weights.push_back(count ? 1 : 0);
  double variance = 0, radius = 1; // of the scale's column, over that of a point
  for (int step = 0; step < kSteps && !fit.converged; ++step) {
    for (std::size_t i = 0; i < points.size(); ++i)
      scaled[i] = whole.centre + fit.scale * (points[i] - whole.centre);
    const MotionScale scale = scaleOf(scaled, fit.mesh_from_path);
    left.mesh_from_path = fit.mesh_from_path;
    radius = scale.radius;
    Mat7 normal = Mat7::Zero();
    Vec7 right = Vec7::Zero();
    double squares = 0, n = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!counts[i]) continue;
      const Vec3 p = fit.mesh_from_path * scaled[i];
      Miss& miss = left.misses[i];
      miss = target.miss(p, miss.foot.face);
      if (!pressed.empty()) miss.distance += pressed[i];
      Vec7 g;
      g << scale.gradient(p, miss.direction), miss.direction.dot(p - scale.centre) / scale.radius;
      normal += g * g.transpose();
      right -= miss.distance * g;
      squares += miss.distance * miss.distance;
      ++n;
    }
    const SymmetricEigen eigen(normal);
    Vec7 change = Vec7::Zero();
    variance = 0;
    for (int k = 0; k < 7; ++k) {
      if (!(eigen.values[k] > kBlind * eigen.values[6])) continue;
      change += eigen.vectors.col(k) * eigen.vectors.col(k).dot(right) / eigen.values[k];
      variance += eigen.vectors(6, k) * eigen.vectors(6, k) / eigen.values[k];
    }
    fit.rms = left.rms = std::sqrt(squares / std::max(n, 1.));
    const double growth = std::clamp(change[6] / scale.radius, -kMostStep, kMostStep);
    Vec6 motion = change.head<6>();
    limit(motion, scale, target.extent());
    fit.mesh_from_path = scale.motion(motion) * fit.mesh_from_path;
    fit.scale *= std::exp(growth);
    fit.converged = std::abs(growth) < kSettledScale;
  }
  const ErrorLaw law = errorLaw(scaled, left, noise);
  fit.deviation = law.deviation * std::sqrt(law.together * variance) / radius;
  return fit;
}

} // namespace patina
