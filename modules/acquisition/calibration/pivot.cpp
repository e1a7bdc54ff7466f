#include "acquisition/calibration/pivot.h"

#include <algorithm>
#include <cmath>

#include "core/decompose.h"

namespace patina {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double kMaxwellMedian = 1.538; // median of |N(0, I3)| (Maxwell distribution)
constexpr double kTukeyCutoff = 4.7;     // [deviations], biweight (Beaton & Tukey 1974)
constexpr double kMinReciprocalCondition =
    1e-3; // smallest reciprocal condition number of the normal equations

// Returns the inverse covariance of a residual. Angle errors do not act along the tip's arm.
Eigen::Matrix3d informationOf(const CameraPose& pose, const Vec3& tip) {
  const Vec3 arm = pose.orientation * tip;
  const double position = pose.sigma_position * pose.sigma_position,
               angle = pose.sigma_angle * pose.sigma_angle;
  const Eigen::Matrix3d spread =
      (position + angle * arm.squaredNorm()) * Eigen::Matrix3d::Identity() -
      angle * arm * arm.transpose();
  return spread.inverse();
}

// Returns a term of the maximum-likelihood gradient, divided by the tip: the residual's covariance
// depends on the tip. Without it, angle noise biases the tip's distance towards zero.
Eigen::Matrix3d covarianceTerm(const CameraPose& pose, const Vec3& weighted_residual) {
  const Vec3 u = pose.orientation.conjugate() * weighted_residual;
  const double angle = pose.sigma_angle * pose.sigma_angle;
  return angle * (u.squaredNorm() * Eigen::Matrix3d::Identity() - u * u.transpose());
}

} // namespace

std::optional<PivotFit> fitPivot(const std::vector<CameraPose>& poses) {
  if (poses.size() < 10) return std::nullopt;
  PivotFit fit;
  std::vector<double> weights(poses.size(), 1), lengths(poses.size());
  double scale = 1;
  std::vector<Eigen::Matrix3d> covariance_terms(poses.size(), Eigen::Matrix3d::Zero());
  Mat6 normal_matrix;
  for (int round = 0; round < 60; ++round) {
    normal_matrix.setZero();
    Vec6 rhs = Vec6::Zero();
    Eigen::Matrix3d covariance_term = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      Eigen::Matrix<double, 3, 6> J;
      J << poses[i].orientation.toRotationMatrix(), -Eigen::Matrix3d::Identity();
      const Eigen::Matrix3d information = weights[i] * informationOf(poses[i], fit.tip);
      normal_matrix += J.transpose() * information * J;
      rhs -= J.transpose() * information * poses[i].position;
      covariance_term -= weights[i] * covariance_terms[i];
    }
    Mat6 hessian = normal_matrix;
    hessian.topLeftCorner<3, 3>() += covariance_term;
    const SymmetricSolver solver(hessian);
    if (!(solver.reciprocalCondition() > kMinReciprocalCondition)) return std::nullopt;
    const Vec6 next = solver.solve(rhs);
    const double step = (next.head<3>() - fit.tip).norm();
    fit.tip = next.head<3>();
    fit.point = next.tail<3>();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Vec3 r = poses[i].orientation * fit.tip + poses[i].position - fit.point;
      const Vec3 weighted_residual = informationOf(poses[i], fit.tip) * r;
      lengths[i] = std::sqrt(r.dot(weighted_residual));
      covariance_terms[i] = covarianceTerm(poses[i], weighted_residual);
    }
    std::vector<double> sorted = lengths;
    std::nth_element(sorted.begin(),
                     sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    scale = std::max(sorted[sorted.size() / 2] / kMaxwellMedian, 1e-9);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double r = lengths[i] / (kTukeyCutoff * scale);
      weights[i] = r < 1 ? (1 - r * r) * (1 - r * r) : 0;
    }
    if (round > 2 && step < 1e-9) break;
  }
  double squares = 0, used = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (weights[i] == 0) {
      ++fit.rejected;
      continue;
    }
    squares += (poses[i].orientation * fit.tip + poses[i].position - fit.point).squaredNorm();
    used += 1;
  }
  fit.rms = std::sqrt(squares / used);
  fit.covariance = scale * scale * SymmetricSolver(normal_matrix).inverse().topLeftCorner<3, 3>();
  return fit;
}

} // namespace patina
