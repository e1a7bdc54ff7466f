#include "acquisition/registration/surface_target.h"

#include <cmath>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kCrease = 0.35; // larger angles between faces are edges of the body [rad]

// Returns the chordal error at each vertex, from the angles between the normals of its faces: an
// edge of length e and angle a deviates by e a / 8 from an arc.
std::vector<float> facetErrors(const TriangleMesh& mesh) {
  const std::size_t n = mesh.positions.size();
  std::vector<Vec3> normal(n, Vec3::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0), twice = (mesh.corner(t, 1) - a).cross(mesh.corner(t, 2) - a);
    for (const std::int32_t v : mesh.triangles[t]) normal[index(v)] += twice;
  }
  std::vector<float> error(n, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 face = faceNormal(mesh, t);
    for (int k = 0; k < 3; ++k) {
      const std::size_t v = index(mesh.triangles[t][static_cast<std::size_t>(k)]);
      const double bend = std::acos(std::clamp(face.dot(normal[v].normalized()), -1.0, 1.0));
      const double edge = (mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k)).norm();
      if (bend < kCrease) error[v] = std::max(error[v], static_cast<float>(edge * bend / 4));
    }
  }
  return error;
}

} // namespace

SurfaceTarget::SurfaceTarget(TriangleMesh mesh, double offset, bool sided)
    : mesh_(std::move(mesh)), tree_(mesh_), offset_(offset), facet_error_(facetErrors(mesh_)) {
  if (offset != 0 || sided)
    side_.emplace(mesh_, std::vector<std::uint8_t>(mesh_.triangles.size(), 1));
  const double longest = bounds(mesh_).sizes().maxCoeff();
  if (2 * std::abs(offset) > longest)
    throw Error("a tip of radius " + formatLength(std::abs(offset)) + " is larger than the mesh (" +
                formatLength(longest) +
                "): lengths without a unit are in metres, and --unit is that of the mesh");
}

SurfaceResidual SurfaceTarget::residual(const Vec3& p, std::int32_t warm_face) const {
  const ClosestPoint closest = tree_.closestPoint(p, warm_face);
  SurfaceResidual residual;
  residual.foot = closest.surface;
  residual.at = closest.point;
  const bool on_face = closest.surface.barycentric.minCoeff() > 0;
  const Vec3 away = p - closest.point;
  const bool behind = side_ && side_->at(p, closest.surface.face) == Side::back;
  if (on_face || closest.distance < 1e-12) {
    residual.direction = faceNormal(mesh_, index(closest.surface.face));
    residual.distance = away.dot(residual.direction);
  } else {
    residual.direction = (behind ? -1 : 1) * away / closest.distance;
    residual.distance = behind ? -closest.distance : closest.distance;
  }
  residual.distance -= offset_;
  return residual;
}

double SurfaceTarget::chordError(std::int32_t face) const {
  double most = 0;
  for (const std::int32_t v : mesh_.triangles[index(face)])
    most = std::max<double>(most, facet_error_[index(v)]);
  return most;
}

} // namespace patina
