#include "geometry/measure/mesh_part.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace patina {

MeshPart partOf(const TriangleMesh& mesh, std::vector<std::int32_t> faces) {
  MeshPart part;
  std::vector<std::int32_t> vertex(mesh.positions.size(), -1); // in the part
  for (const std::int32_t f : faces) {
    std::array<std::int32_t, 3>& corners = part.mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t whole = mesh.triangles[static_cast<std::size_t>(f)][k];
      std::int32_t& own = vertex[static_cast<std::size_t>(whole)];
      if (own < 0) {
        own = static_cast<std::int32_t>(part.mesh.positions.size());
        part.mesh.positions.push_back(mesh.positions[static_cast<std::size_t>(whole)]);
      }
      corners[k] = own;
    }
  }
  part.face = std::move(faces);
  return part;
}

MeshPart partWithin(const TriangleMesh& mesh, const Vec3& a, const Vec3& b, double longest) {
  std::vector<std::int32_t> faces;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Vec3 centre = (mesh.corner(f, 0) + mesh.corner(f, 1) + mesh.corner(f, 2)) / 3;
    double radius = 0;
    for (int k = 0; k < 3; ++k) radius = std::max(radius, (mesh.corner(f, k) - centre).norm());
    if ((centre - a).norm() + (centre - b).norm() - 2 * radius <=
        longest + 1e-9 * radius) // a point of the face may lie off it by rounding
      faces.push_back(static_cast<std::int32_t>(f));
  }
  return partOf(mesh, std::move(faces));
}

SurfacePoint pointOfPart(const MeshPart& part, const SurfacePoint& point) {
  const auto at = std::lower_bound(part.face.begin(), part.face.end(), point.face);
  if (at == part.face.end() || *at != point.face)
    throw std::invalid_argument("pointOfPart: the part lacks the point's face");
  return {static_cast<std::int32_t>(at - part.face.begin()), point.barycentric};
}

} // namespace patina
