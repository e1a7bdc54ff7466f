#include "acquisition/registration/error_map.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace patina {
namespace {

using Cell = std::array<long, 3>;

Cell cellOf(const Vec3& p, double side) {
  return {std::lround(std::floor(p.x() / side)), std::lround(std::floor(p.y() / side)),
          std::lround(std::floor(p.z() / side))};
}

Vec3 normalOf(const TriangleMesh& mesh, std::size_t face) {
  const Vec3 a = mesh.corner(face, 0);
  return (mesh.corner(face, 1) - a).cross(mesh.corner(face, 2) - a);
}

} // namespace

std::vector<float> errorMapOf(const TriangleMesh& mesh, const Registration& registration,
                              double reach) {
  if (!(reach > 0)) throw std::invalid_argument("error map: a reach is above 0");
  std::map<Cell, std::vector<std::size_t>> samples;
  for (std::size_t i = 0; i < registration.residuals.size(); ++i)
    if (registration.inliers[i] && registration.residuals[i].foot.face != kNone)
      samples[cellOf(registration.residuals[i].at, reach)].push_back(i);
  std::vector<Vec3> normals(mesh.positions.size(), Vec3::Zero());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (const std::int32_t v : mesh.triangles[f])
      normals[static_cast<std::size_t>(v)] += normalOf(mesh, f);
  std::vector<float> error(mesh.positions.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t v = 0; v < error.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    const Cell middle = cellOf(p, reach);
    double sum = 0, weights = 0;
    for (int k = 0; k < 27; ++k) {
      const auto cell =
          samples.find({middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1});
      if (cell == samples.end()) continue;
      for (const std::size_t i : cell->second) {
        const SurfaceResidual& residual = registration.residuals[i];
        const double near = 1 - (residual.at - p).squaredNorm() / (reach * reach);
        if (near <= 0 ||
            normals[v].dot(normalOf(mesh, static_cast<std::size_t>(residual.foot.face))) < 0)
          continue;
        sum += near * near * std::abs(residual.distance);
        weights += near * near;
      }
    }
    if (weights > 0) error[v] = static_cast<float>(sum / weights);
  }
  return error;
}

} // namespace patina
