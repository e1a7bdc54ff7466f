#include "acquisition/registration/local_motion.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/decompose.h"
#include "core/percentiles.h"

namespace patina {
namespace {

constexpr std::size_t kMotionWindow = 20, kMotionMinWindow = 10; // samples to either side
constexpr double kMotionPause = 5; // median time steps; a longer pause starts another segment

} // namespace

std::vector<LocalMotion> localMotions(const std::vector<PathSample>& path) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < path.size(); ++i) steps.push_back(path[i].t - path[i - 1].t);
  const double pause = steps.empty() ? 0 : kMotionPause * percentiles(steps).p50;
  std::vector<LocalMotion> motions(path.size());
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= path.size(); ++i) {
    const double step = i < path.size() ? path[i].t - path[i - 1].t : -1;
    if (step > 0 && step <= pause) continue;
    const std::size_t least = std::min(kMotionMinWindow, (i - begin - 1) / 2);
    for (std::size_t k = begin; k < i; ++k) {
      motions[k].begin = begin;
      motions[k].end = i;
      motions[k].force = path[k].force;
      if (least < 2) continue;
      // The window is symmetric to avoid bias; samples near an end use the nearest parabola.
      const std::size_t middle = std::clamp(k, begin + least, i - 1 - least);
      const std::size_t half = std::min({middle - begin, i - 1 - middle, kMotionWindow});
      const std::size_t low = middle - half, high = middle + half;
      Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
      Eigen::Matrix<double, 3, 4> right = Eigen::Matrix<double, 3, 4>::Zero();
      const double scale = path[high].t - path[low].t;
      for (std::size_t j = low; j <= high; ++j) {
        const double u = (path[j].t - path[k].t) / scale;
        const Vec3 terms(1, u, u * u);
        Eigen::RowVector4d values;
        values << (path[j].position - path[k].position).transpose(), path[j].force;
        normal += terms * terms.transpose();
        right += terms * values;
      }
      const Eigen::Matrix3d inverse = SymmetricSolver(normal).inverse();
      const Eigen::Matrix<double, 3, 4> parabola = inverse * right;
      motions[k].rate_variance = inverse(1, 1) / (scale * scale);
      motions[k].velocity = parabola.row(1).head<3>().transpose() / scale;
      motions[k].acceleration = 2 * parabola.row(2).head<3>().transpose() / (scale * scale);
      motions[k].force = parabola(0, 3);
      motions[k].force_rate = parabola(1, 3) / scale;
      motions[k].force_curvature = 2 * parabola(2, 3) / (scale * scale);
      const Eigen::AngleAxisd turn(path[high].orientation * path[low].orientation.conjugate());
      motions[k].angular_velocity = turn.angle() / scale * turn.axis();
    }
    begin = i;
  }
  return motions;
}

SmoothForce forceBefore(const std::vector<PathSample>& path,
                        const std::vector<LocalMotion>& motions, std::size_t sample,
                        double earlier) {
  const double t = path[sample].t - earlier;
  // Sampling is nearly uniform, so few steps lead to the nearest sample.
  std::size_t near = sample;
  while (near > motions[sample].begin && path[near - 1].t + path[near].t > 2 * t) --near;
  while (near + 1 < motions[sample].end && path[near].t + path[near + 1].t < 2 * t) ++near;
  const LocalMotion& there = motions[near];
  const double off = t - path[near].t;
  const bool beyond =
      off < 0 ? near == motions[sample].begin : off > 0 && near + 1 == motions[sample].end;
  if (beyond) return {there.force, 0};
  return {there.force + off * (there.force_rate + 0.5 * off * there.force_curvature),
          there.force_rate + off * there.force_curvature};
}

} // namespace patina
