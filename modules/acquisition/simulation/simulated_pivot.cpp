#include "acquisition/simulation/simulated_pivot.h"

#include <cmath>
#include <numbers>
#include <random>

namespace patina {

std::vector<CameraPose> simulatePivot(const SimulatedPivot& pivot, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit;
  const auto noise = [&](double sigma) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(sigma * Vec3(x, y, z));
  };
  const auto turn = [](double angle, const Vec3& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
  };
  std::vector<CameraPose> poses;
  for (int i = 0; i < pivot.poses; ++i) {
    const double around = 2 * std::numbers::pi * unit(random);
    const double leaning = pivot.cone * std::sqrt(unit(random));
    const double roll = 2 * std::numbers::pi * unit(random);
    const Eigen::Quaterniond known =
        turn(around, Vec3::UnitZ()) * turn(leaning, Vec3::UnitX()) * turn(roll, Vec3::UnitZ());
    const Vec3 error = noise(pivot.sigma_angle);
    CameraPose pose;
    pose.t = i / 30.;
    pose.orientation = known * turn(error.norm(), error.normalized());
    pose.position = pivot.point - known * pivot.tip + noise(pivot.sigma_position);
    if (unit(random) < pivot.outliers) pose.position += pivot.outlier_size * noise(1).normalized();
    pose.sigma_position = pivot.sigma_position;
    pose.sigma_angle = pivot.sigma_angle;
    poses.push_back(pose);
  }
  return poses;
}

} // namespace patina
