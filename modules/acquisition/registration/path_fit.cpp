#include "acquisition/registration/path_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/decompose.h"

namespace patina {
namespace {

constexpr double kInlier = 3;      // standard deviations
constexpr double kSettled = 1e-2;  // tolerance of a step over its deviation
constexpr double kNormal = 1.4826; // deviation over median of absolute normal errors

// Returns the standard deviation of the better half (MAD, Hampel 1974).
double spreadOf(std::vector<double> sizes) {
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return kNormal * *middle;
}

struct Working {
  const SurfaceTarget& target;
  const std::vector<Vec3>& points;
  const std::vector<double>& indentations;
  PathFit fit;

  void evaluate(const Pose& pose, std::vector<SurfaceResidual>& residuals) {
    residuals.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].allFinite()) continue;
      residuals[i] = target.residual(pose * points[i], residuals[i].foot.face);
      if (!indentations.empty()) residuals[i].distance += indentations[i];
      ++fit.evaluations;
    }
  }

  double cost(const std::vector<SurfaceResidual>& residuals) const {
    double sum = 0;
    for (std::size_t i = 0; i < residuals.size(); ++i)
      sum += fit.weights[i] * residuals[i].distance * residuals[i].distance;
    return sum;
  }

  double inlierCount() const {
    return static_cast<double>(
        std::count_if(fit.weights.begin(), fit.weights.end(), [](double w) { return w > 0; }));
  }

  std::vector<double> sizes() const {
    std::vector<double> sizes;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i].allFinite()) sizes.push_back(std::abs(fit.residuals[i].distance));
    return sizes;
  }

  Vec6 normalEquations(const PoseScaling& scale) {
    fit.normal.setZero();
    Vec6 right = Vec6::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (fit.weights[i] == 0) continue;
      const Vec6 g = scale.gradient(fit.mesh_from_path * points[i], fit.residuals[i].direction);
      fit.normal.selfadjointView<Eigen::Lower>().rankUpdate(g, fit.weights[i]);
      right -= fit.weights[i] * fit.residuals[i].distance * g;
    }
    fit.normal = fit.normal.selfadjointView<Eigen::Lower>();
    return right;
  }

  // Iterates until convergence; `reweigh` is called before each step and returns true on changes.
  template <class Reweigh> void run(int iterations, double tiny, Reweigh&& reweigh) {
    const double extent = target.extent();
    double damping = 0;
    for (fit.converged = false; iterations > 0 && !fit.converged; --iterations) {
      const bool free = reweigh(); // costs of different weights are not comparable
      const PoseScaling scale = scaleOf(points, fit.mesh_from_path);
      const Vec6 right = normalEquations(scale);
      const SymmetricEigen eigen(fit.normal);
      const double largest = std::max(eigen.values[5], 1e-300);
      const double before = cost(fit.residuals);
      const double enough = kSettled * std::sqrt(before / std::max(inlierCount(), 1.0));
      ++fit.iterations;
      for (;;) {
        Vec6 step = Vec6::Zero();
        for (int k = 0; k < 6; ++k)
          if (eigen.values[k] > kRankTolerance * largest)
            step += eigen.vectors.col(k) * eigen.vectors.col(k).dot(right) /
                    (eigen.values[k] + damping * largest);
        limit(step, scale, extent);
        const Pose next = scale.motion(step) * fit.mesh_from_path;
        std::vector<SurfaceResidual> residuals = fit.residuals;
        evaluate(next, residuals);
        const double after = cost(residuals);
        const bool still = step.norm() < tiny || std::sqrt(step.dot(fit.normal * step)) < enough;
        if (after <= before || free || still) {
          fit.last_rotation = step.head<3>().norm() / scale.radius;
          fit.last_translation = step.tail<3>().norm();
          fit.converged = still;
          if (after <= before || free) {
            fit.mesh_from_path = next;
            fit.residuals = std::move(residuals);
          }
          damping = damping < 1e-6 ? 0 : damping / 10;
          break;
        }
        damping = std::max(1e-4, damping * 10);
      }
    }
  }
};

} // namespace

Pose PoseScaling::motion(const Vec6& lengths) const {
  const Vec3 turn = lengths.head<3>() / radius;
  const double angle = turn.norm();
  Pose pose = Pose::Identity();
  if (angle > 0) pose.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  pose.translation() = centre - pose.linear() * centre + lengths.tail<3>();
  return pose;
}

Vec6 PoseScaling::gradient(const Vec3& at, const Vec3& direction) const {
  Vec6 g;
  g << (at - centre).cross(direction) / radius, direction;
  return g;
}

void limit(Vec6& step, const PoseScaling& scale, double extent) {
  const double turn = step.head<3>().norm() / (scale.radius / 2),
               shift = step.tail<3>().norm() / (std::max(extent, scale.radius) / 4);
  step /= std::max({1.0, turn, shift});
}

PoseScaling scaleOf(const std::vector<Vec3>& points, const Pose& mesh_from_path) {
  PoseScaling scale;
  Vec3 sum = Vec3::Zero();
  std::size_t n = 0;
  for (const Vec3& p : points)
    if (p.allFinite()) {
      sum += p;
      ++n;
    }
  const Vec3 mean = sum / static_cast<double>(std::max<std::size_t>(n, 1));
  double squares = 0;
  for (const Vec3& p : points)
    if (p.allFinite()) squares += (p - mean).squaredNorm();
  scale.centre = mesh_from_path * mean;
  scale.radius = std::max(std::sqrt(squares / static_cast<double>(std::max<std::size_t>(n, 1))),
                          1e-9); // for a single point
  return scale;
}

double inlierThreshold(std::vector<double> sizes, double noise) {
  return kInlier * std::max(noise, spreadOf(std::move(sizes)));
}

PathFit fitPath(const SurfaceTarget& target, const std::vector<Vec3>& points, const Pose& start,
                const FitOptions& options) {
  Working work{target, points, options.indentations, {}};
  PathFit& fit = work.fit;
  fit.mesh_from_path = start;
  for (const Vec3& p : points) fit.weights.push_back(p.allFinite() ? 1 : 0);
  if (std::count(fit.weights.begin(), fit.weights.end(), 1) == 0)
    throw std::invalid_argument("fitPath: no point is finite");
  work.evaluate(start, fit.residuals);
  const double tiny = 1e-8 * scaleOf(points, start).radius;
  const auto countAll = [&](auto&& weight) {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i].allFinite()) fit.weights[i] = weight(std::abs(fit.residuals[i].distance));
  };
  int left = options.iterations;
  if (options.noise > 0) {
    // Robust weights; their scale follows from the better half of the residuals.
    work.run(left / 2, 1e-2 * options.noise, [&] {
      const double s = std::max(options.noise, 1.5 * spreadOf(work.sizes()));
      countAll([&](double r) {
        const double q = s * s / (s * s + r * r);
        return q * q;
      });
      return true;
    });
    left -= fit.iterations;
  }
  for (int round = 0; round < 8; ++round) {
    std::vector<double> before = fit.weights;
    if (options.noise > 0) {
      const double most = inlierThreshold(work.sizes(), options.noise);
      countAll([&](double r) { return r <= most ? 1.0 : 0.0; });
      if (round > 0 && before == fit.weights) break;
    }
    work.run(options.noise > 0 ? std::max(left, 5) : left, tiny, [] { return false; });
    if (options.noise <= 0) break;
  }
  fit.rms = std::sqrt(work.cost(fit.residuals) / std::max(work.inlierCount(), 1.0));
  work.normalEquations(scaleOf(points, fit.mesh_from_path));
  return std::move(work.fit);
}

} // namespace patina
