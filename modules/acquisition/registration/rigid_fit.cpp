#include "acquisition/registration/rigid_fit.h"

#include <stdexcept>

#include "core/decompose.h"

namespace patina {
namespace {

constexpr double kPlanar = 1e-6; // smallest over largest singular value of planar points

Vec3 mean(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

void requirePairs(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  if (from.empty() || from.size() != to.size())
    throw std::invalid_argument("points to be fitted come in pairs");
}

// Returns the rotation nearest to a matrix.
Eigen::Matrix3d nearestTurn(const Eigen::Matrix3d& matrix) {
  const Svd svd(matrix);
  Eigen::Matrix3d u = svd.u;
  const Eigen::Matrix3d v = svd.v;
  if (u.determinant() * v.determinant() < 0) u.col(2) *= -1;
  return u * v.transpose();
}

} // namespace

Pose fitRigid(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  requirePairs(from, to);
  const Vec3 a = mean(from), b = mean(to);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) cross += (to[i] - b) * (from[i] - a).transpose();
  Pose pose = Pose::Identity();
  pose.linear() = nearestTurn(cross);
  pose.translation() = b - pose.linear() * a;
  return pose;
}

std::optional<Pose> fitAffineThenRigid(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  requirePairs(from, to);
  const Vec3 a = mean(from), b = mean(to);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero(), own = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    cross += (to[i] - b) * (from[i] - a).transpose();
    own += (from[i] - a) * (from[i] - a).transpose();
  }
  const VecX spread = SymmetricEigen(own).values;
  if (!(spread[0] > kPlanar * kPlanar * spread[2])) return std::nullopt;
  Pose pose = Pose::Identity();
  pose.linear() = nearestTurn(cross * own.inverse());
  pose.translation() = b - pose.linear() * a;
  return pose;
}

} // namespace patina
