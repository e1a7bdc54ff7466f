#include "acquisition/calibration/pivot.h"

#include <algorithm>
#include <cmath>

#include "core/decompose.h"

namespace patina {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double kChi = 1.538;  // median length of a normal vector of three
constexpr double kFarOut = 4.7; // what is farther out, in deviations, does not count
constexpr double kOpen = 1e-3;  // of the normal equations' largest: what is less is not known

// Inverse of what a pose's deviations make of its residual: along the tip's arm the angle does
// nothing.
Eigen::Matrix3d informationOf(const CameraPose& pose, const Vec3& tip) {
  const Vec3 arm = pose.orientation * tip;
  const double position = pose.sigma_position * pose.sigma_position,
               angle = pose.sigma_angle * pose.sigma_angle;
  const Eigen::Matrix3d spread =
      (position + angle * arm.squaredNorm()) * Eigen::Matrix3d::Identity() -
      angle * arm * arm.transpose();
  return spread.inverse();
}

// The residual's deviation grows with the tip, too, and the likeliest tip knows it: times the tip,
// what that adds to the gradient. Without it errors of the angle shorten the arm, by their square
// over that of how far the probe turned. `pull`: information times residual.
Eigen::Matrix3d bendOf(const CameraPose& pose, const Vec3& pull) {
  const Vec3 u = pose.orientation.conjugate() * pull;
  const double angle = pose.sigma_angle * pose.sigma_angle;
  return angle * (u.squaredNorm() * Eigen::Matrix3d::Identity() - u * u.transpose());
}

} // namespace

std::optional<PivotFit> fitPivot(const std::vector<CameraPose>& poses) {
  if (poses.size() < 10) return std::nullopt;
  PivotFit fit;
  std::vector<double> weights(poses.size(), 1), lengths(poses.size());
  double scale = 1;
  std::vector<Eigen::Matrix3d> bends(poses.size(), Eigen::Matrix3d::Zero());
  Mat6 normal;
  for (int round = 0; round < 60; ++round) {
    normal.setZero();
    Vec6 right = Vec6::Zero();
    Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      Eigen::Matrix<double, 3, 6> J;
      J << poses[i].orientation.toRotationMatrix(), -Eigen::Matrix3d::Identity();
      const Eigen::Matrix3d information = weights[i] * informationOf(poses[i], fit.tip);
      normal += J.transpose() * information * J;
      right -= J.transpose() * information * poses[i].position;
      bend -= weights[i] * bends[i];
    }
    Mat6 honest = normal;
    honest.topLeftCorner<3, 3>() += bend;
    const SymmetricSolver solver(honest);
    if (!(solver.evenness() > kOpen)) return std::nullopt;
    const Vec6 next = solver.solve(right);
    const double step = (next.head<3>() - fit.tip).norm();
    fit.tip = next.head<3>();
    fit.point = next.tail<3>();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Vec3 r = poses[i].orientation * fit.tip + poses[i].position - fit.point;
      const Vec3 pull = informationOf(poses[i], fit.tip) * r;
      lengths[i] = std::sqrt(r.dot(pull));
      bends[i] = bendOf(poses[i], pull);
    }
    std::vector<double> sorted = lengths;
    std::nth_element(sorted.begin(),
                     sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    scale = std::max(sorted[sorted.size() / 2] / kChi, 1e-9);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double r = lengths[i] / (kFarOut * scale);
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
  fit.covariance = scale * scale * SymmetricSolver(normal).inverse().topLeftCorner<3, 3>();
  return fit;
}

} // namespace patina
