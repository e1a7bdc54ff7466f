#include "acquisition/registration/closest_point_loop.h"

#include <cmath>

#include "acquisition/registration/rigid_fit.h"

namespace patina {

LoopFit closestPointLoop(const SurfaceTarget& target, const std::vector<Vec3>& points,
                         const Pose& start, const LoopOptions& options) {
  std::vector<Vec3> from, to;
  for (const Vec3& p : points)
    if (p.allFinite()) from.push_back(p);
  to.resize(from.size());
  std::vector<std::int32_t> face(from.size(), kNone);
  LoopFit fit;
  fit.mesh_from_path = start;
  const auto project = [&] {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const ClosestPoint closest =
          target.tree().closestPoint(fit.mesh_from_path * from[i], face[i]);
      to[i] = closest.point;
      face[i] = closest.surface.face;
      sum += closest.distance;
      squares += closest.distance * closest.distance;
    }
    fit.mean_distance = sum / static_cast<double>(from.size());
    fit.mean_square = squares / static_cast<double>(from.size());
  };
  project();
  while (fit.iterations < options.iterations && !fit.converged) {
    std::optional<Pose> next;
    if (options.literal) next = fitAffineThenRigid(from, to);
    fit.fell_back = options.literal && !next;
    if (!next) next = fitRigid(from, to);
    const Pose step = *next * fit.mesh_from_path.inverse();
    fit.last_turn = Eigen::AngleAxisd(step.linear()).angle();
    fit.last_shift = (*next * from[0] - fit.mesh_from_path * from[0]).norm();
    fit.mesh_from_path = *next;
    const double before = fit.mean_distance;
    project();
    ++fit.iterations;
    fit.converged = std::abs(before - fit.mean_distance) < options.still;
  }
  return fit;
}

} // namespace patina
