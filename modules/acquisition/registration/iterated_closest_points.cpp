#include "acquisition/registration/iterated_closest_points.h"

#include <cmath>

#include "acquisition/registration/rigid_fit.h"

namespace patina {

IcpResult iteratedClosestPoints(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                const Pose& start, const IcpOptions& options) {
  std::vector<Vec3> from, to;
  for (const Vec3& p : points)
    if (p.allFinite()) from.push_back(p);
  to.resize(from.size());
  std::vector<std::int32_t> face(from.size(), kNone);
  IcpResult fit;
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
    if (options.affine) next = fitAffineThenRigid(from, to);
    fit.fell_back = options.affine && !next;
    if (!next) next = fitRigid(from, to);
    const Pose step = *next * fit.mesh_from_path.inverse();
    fit.last_rotation = Eigen::AngleAxisd(step.linear()).angle();
    fit.last_translation = (*next * from[0] - fit.mesh_from_path * from[0]).norm();
    fit.mesh_from_path = *next;
    const double before = fit.mean_distance;
    project();
    ++fit.iterations;
    fit.converged = std::abs(before - fit.mean_distance) < options.tolerance;
  }
  return fit;
}

} // namespace patina
