#include "geometry/mesh/triangle_mesh.h"

#include <utility>

namespace patina {

Box3 bounds(const TriangleMesh& mesh) {
  Box3 box;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) box.extend(mesh.corner(t, k));
  return box;
}

Vec3 position(const TriangleMesh& mesh, const SurfacePoint& point) {
  const auto face = static_cast<std::size_t>(point.face);
  return point.barycentric[0] * mesh.corner(face, 0) + point.barycentric[1] * mesh.corner(face, 1) +
         point.barycentric[2] * mesh.corner(face, 2);
}

namespace {
Vec3 doubleAreaVector(const TriangleMesh& mesh, std::size_t triangle) {
  const Vec3 a = mesh.corner(triangle, 0);
  return (mesh.corner(triangle, 1) - a).cross(mesh.corner(triangle, 2) - a);
}
} // namespace

Vec3 faceNormal(const TriangleMesh& mesh, std::size_t triangle) {
  // Scales the edges to unit size first, because squares of tiny lengths would underflow.
  const Vec3 a = mesh.corner(triangle, 0);
  Vec3 e1 = mesh.corner(triangle, 1) - a;
  Vec3 e2 = mesh.corner(triangle, 2) - a;
  const double size = std::max(e1.cwiseAbs().maxCoeff(), e2.cwiseAbs().maxCoeff());
  if (!(size > 0)) return Vec3::Zero();
  e1 /= size;
  e2 /= size;
  const Vec3 normal = e1.cross(e2);
  const double length = normal.norm();
  if (!(length > 0)) return Vec3::Zero();
  return normal / length;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += doubleAreaVector(mesh, t).norm();
  return sum / 2;
}

double volume(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  // Uses a point of the mesh as origin: far from it the terms would cancel badly.
  const Vec3 origin = mesh.corner(0, 0);
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += (mesh.corner(t, 0) - origin).dot(doubleAreaVector(mesh, t));
  return sum / 6;
}

TriangleMesh transformed(const TriangleMesh& mesh, const Eigen::Affine3d& target_from_mesh) {
  TriangleMesh result = mesh;
  for (Vec3& p : result.positions) p = target_from_mesh * p;
  if (target_from_mesh.linear().determinant() < 0) {
    for (Triangle& t : result.triangles) std::swap(t[1], t[2]);
    for (auto& uv : result.corner_uvs) std::swap(uv[1], uv[2]);
  }
  return result;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  if (other.triangles.empty()) return;
  if (mesh.triangles.empty()) {
    mesh = other;
    return;
  }
  const auto offset = static_cast<std::int32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  if (mesh.corner_uvs.empty() || other.corner_uvs.empty())
    mesh.corner_uvs.clear();
  else
    mesh.corner_uvs.insert(mesh.corner_uvs.end(), other.corner_uvs.begin(), other.corner_uvs.end());
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh result = a;
  append(result, b);
  return result;
}

void removeUnusedVertices(TriangleMesh& mesh) {
  std::vector<std::int32_t> index_of(mesh.positions.size(), -1);
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t) index_of[static_cast<std::size_t>(v)] = 0;
  std::int32_t used = 0;
  for (std::size_t v = 0; v < index_of.size(); ++v) {
    if (index_of[v] < 0) continue;
    mesh.positions[static_cast<std::size_t>(used)] = mesh.positions[v];
    index_of[v] = used++;
  }
  mesh.positions.resize(static_cast<std::size_t>(used));
  for (Triangle& t : mesh.triangles)
    for (std::int32_t& v : t) v = index_of[static_cast<std::size_t>(v)];
}

} // namespace patina
