#include "acquisition/registration/unobservable_motions.h"

#include <cmath>
#include <cstdio>

#include "core/decompose.h"

namespace patina {
namespace {

// Relative eigenvalue; stiffer motions are observable without a trial.
constexpr double kWeakEigenvalue = 3e-2;
constexpr double kMaxDeviation = 10; // times the noise: largest deviation of an observable motion

struct Trial {
  const SurfaceTarget& target;
  const std::vector<Vec3>& points;
  const PathFit& fit;
  double noise, correlation_length;
  const std::vector<double>& indentations;
  PoseScaling scale;

  double chordError() const { // rms over the inliers [m]
    double squares = 0, n = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (fit.weights[i] > 0) {
        const double e = target.chordError(fit.residuals[i].foot.face);
        squares += e * e;
        ++n;
      }
    return std::sqrt(squares / std::max(n, 1.0));
  }

  // Returns the mean squared residual after a motion along `direction` and a fit of all others.
  double squareAfter(const Vec6& direction, double length) const {
    Pose moved = scale.motion(length * direction) * fit.mesh_from_path;
    double square = 0;
    for (int round = 0; round < 3; ++round) {
      Mat6 normal = Mat6::Zero();
      Vec6 right = Vec6::Zero();
      double n = 0;
      square = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (fit.weights[i] == 0) continue;
        const Vec3 p = moved * points[i];
        SurfaceResidual residual = target.residual(p, fit.residuals[i].foot.face);
        if (!indentations.empty()) residual.distance += indentations[i];
        Vec6 g = scale.gradient(p, residual.direction);
        g -= direction * direction.dot(g);
        normal += g * g.transpose();
        right -= residual.distance * g;
        square += residual.distance * residual.distance;
        ++n;
      }
      square /= n;
      const SymmetricEigen eigen(normal);
      Vec6 step = Vec6::Zero();
      for (int k = 0; k < 6; ++k)
        if (eigen.values[k] > 1e-4 * eigen.values[5])
          step += eigen.vectors.col(k) * eigen.vectors.col(k).dot(right) / eigen.values[k];
      if (round < 2) moved = scale.motion(step) * moved;
    }
    return square;
  }

  bool isUnobservable(const Vec6& direction) const {
    const double facets = chordError();
    double n = 0;
    for (const double w : fit.weights) n += w > 0 ? 1 : 0;
    const double shared = correlation_length * noise * noise / std::max(n - 6, 1.0);
    const double most = fit.rms * fit.rms + facets * facets + shared;
    // Exceeds the chordal errors but stays on the body.
    const double length = std::min(kMaxDeviation * std::max(noise, 2 * facets), scale.radius / 2);
    return squareAfter(direction, length) < most && squareAfter(direction, -length) < most;
  }
};

// Lists translations first, then rotations about orthogonal axes, each through the axis point
// nearest to the path and without the shift that a translation covers.
std::vector<UnobservableMotion> named(const Eigen::MatrixXd& basis, const PoseScaling& scale) {
  const Svd svd(basis.topRows(3));
  std::vector<UnobservableMotion> slides, turns;
  for (Eigen::Index k = basis.cols() - 1; k >= 0; --k) {
    const double turn = k < svd.values.size() ? svd.values[k] : 0;
    const Vec6 motion = basis * svd.v.col(k);
    const Vec3 angle = motion.head<3>() / scale.radius;
    Vec3 shift = motion.tail<3>();
    if (turn < 0.05) { // nearly none
      slides.push_back(
          {UnobservableMotion::Kind::translation, shift.normalized(), Vec3::Zero(), 0});
      continue;
    }
    for (const UnobservableMotion& slide : slides) shift -= slide.axis * slide.axis.dot(shift);
    const Vec3 axis = angle.normalized();
    turns.push_back({UnobservableMotion::Kind::rotation, axis,
                     scale.centre + angle.cross(shift) / angle.squaredNorm(),
                     axis.dot(shift) / angle.norm()});
  }
  slides.insert(slides.end(), turns.begin(), turns.end());
  for (UnobservableMotion& motion : slides) { // the largest component is positive
    Eigen::Index largest;
    motion.axis.cwiseAbs().maxCoeff(&largest);
    if (motion.axis[largest] < 0) motion.axis = -motion.axis;
  }
  return slides;
}

std::string direction(const Vec3& v) {
  const auto tidy = [](double x) { return std::abs(x) < 5e-4 ? 0.0 : x; };
  char text[80];
  std::snprintf(text, sizeof text, "(%.3g, %.3g, %.3g)", tidy(v[0]), tidy(v[1]), tidy(v[2]));
  return text;
}

void add(UnobservableMotions& free, const Vec6& direction) {
  free.basis.conservativeResize(6, free.basis.cols() + 1);
  free.basis.rightCols(1) = direction;
}

} // namespace

std::string inWords(const UnobservableMotion& motion) {
  if (motion.kind == UnobservableMotion::Kind::translation)
    return "free to slide along " + direction(motion.axis);
  return "free to turn about the axis " + direction(motion.axis) + " through " +
         direction(1e3 * motion.axis_point) + " mm";
}

UnobservableMotions unobservableMotions(const SurfaceTarget& target,
                                        const std::vector<Vec3>& points, const PathFit& fit,
                                        double noise, double correlation_length,
                                        const std::vector<double>& indentations) {
  const Trial trial{target,
                    points,
                    fit,
                    noise,
                    correlation_length,
                    indentations,
                    scaleOf(points, fit.mesh_from_path)};
  const SymmetricEigen eigen(fit.normal);
  UnobservableMotions free;
  for (int k = 0; k < 6; ++k) {
    const Vec6 direction = eigen.vectors.col(k);
    const double share = eigen.values[k] / eigen.values[5];
    if (share > kWeakEigenvalue || (share > kRankTolerance && !trial.isUnobservable(direction)))
      continue;
    add(free, direction);
  }
  if (free.basis.cols() > 0) free.named = named(free.basis, trial.scale);
  return free;
}

void addPoorlyKnown(UnobservableMotions& free, const ResidualNoiseModel& law,
                    const PoseScaling& scale) {
  const Eigen::Index before = free.basis.cols();
  while (free.basis.cols() < 6) {
    const SymmetricEigen eigen(law.covariance(free.basis));
    // Rounding may make a variance of a nearly singular matrix negative.
    const int most = -eigen.values[0] > eigen.values[5] ? 0 : 5;
    if (!(std::sqrt(std::abs(eigen.values[most])) > scale.radius / 2)) break;
    add(free, eigen.vectors.col(most));
  }
  if (free.basis.cols() > before) free.named = named(free.basis, scale);
}

} // namespace patina
