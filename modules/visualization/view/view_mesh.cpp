#include "visualization/view/view_mesh.h"

#include <algorithm>
#include <utility>

namespace patina {

TriangleMesh withoutObjects(const TriangleMesh& mesh, const Scene& scene,
                            const std::vector<bool>& left_out) {
  TriangleMesh rest;
  rest.positions = mesh.positions;
  auto next = mesh.triangles.begin();
  for (std::size_t object = 0; object < scene.objects.size(); ++object) {
    const auto end =
        next + static_cast<std::ptrdiff_t>(scene.objects[object].mesh->triangles.size());
    if (!left_out[object]) rest.triangles.insert(rest.triangles.end(), next, end);
    next = end;
  }
  return rest;
}

std::vector<Vec3> outermostPoints(const TriangleMesh& mesh, const Vec3& centre, double shell) {
  std::vector<Vec3> points;
  // A mesh of many triangles has every vertex as the first of some.
  const bool coarse = mesh.triangles.size() < 10'000;
  for (const Triangle& triangle : mesh.triangles)
    for (std::size_t k = 0; k < (coarse ? 3 : 1); ++k) {
      const Vec3& point = mesh.positions[static_cast<std::size_t>(triangle[k])];
      if (!point.allFinite()) continue;
      points.push_back(point);
      if (shell > 0) points.push_back(point + shell * Vec3(point - centre).normalized());
    }
  return points;
}

std::vector<Vec3> verticesNear(const TriangleMesh& mesh, const Ray& view_ray, const Ray& reach,
                               std::size_t most) {
  std::vector<std::pair<double, Vec3>> near; // squared distance over that of the reach
  for (const Vec3& p : mesh.positions) {
    const Vec3 away = p - view_ray.origin;
    const double depth = away.dot(view_ray.direction);
    const double off = (away - depth * view_ray.direction).squaredNorm();
    const double allowed =
        (reach.origin - view_ray.origin + depth * (reach.direction - view_ray.direction))
            .squaredNorm();
    if (depth > 0 && off < allowed) near.emplace_back(off / allowed, p);
  }
  std::sort(near.begin(), near.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Vec3> vertices;
  for (std::size_t i = 0; i < std::min(near.size(), most); ++i) vertices.push_back(near[i].second);
  return vertices;
}

} // namespace patina
