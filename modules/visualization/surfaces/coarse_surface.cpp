#include "visualization/surfaces/coarse_surface.h"

#include <unordered_map>
#include <vector>

namespace patina {

TriangleMesh coarsened(const TriangleMesh& mesh, int cells) {
  TriangleMesh coarse;
  const Box3 box = bounds(mesh);
  if (box.isEmpty()) return coarse;
  const double side = std::max(box.sizes().maxCoeff() / cells, 1e-300);
  std::unordered_map<std::int64_t, std::int32_t> vertex_in;
  std::vector<double> count;
  std::vector<std::int32_t> vertex_of(mesh.positions.size(), -1);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    if (!p.allFinite() || !box.contains(p)) continue;
    const Eigen::Matrix<std::int64_t, 3, 1> cell =
        ((p - box.min()) / side).array().floor().cast<std::int64_t>();
    const std::int64_t across = cells + 1;
    const auto [at, is_new] =
        vertex_in.try_emplace((cell[0] * across + cell[1]) * across + cell[2],
                              static_cast<std::int32_t>(coarse.positions.size()));
    if (is_new) {
      coarse.positions.emplace_back(Vec3::Zero());
      count.push_back(0);
    }
    vertex_of[v] = at->second;
    coarse.positions[static_cast<std::size_t>(at->second)] += p;
    ++count[static_cast<std::size_t>(at->second)];
  }
  for (std::size_t v = 0; v < count.size(); ++v) coarse.positions[v] /= count[v];
  for (const Triangle& triangle : mesh.triangles) {
    Triangle made;
    for (std::size_t k = 0; k < 3; ++k) made[k] = vertex_of[static_cast<std::size_t>(triangle[k])];
    const bool whole = made[0] >= 0 && made[1] >= 0 && made[2] >= 0;
    if (whole && made[0] != made[1] && made[1] != made[2] && made[2] != made[0])
      coarse.triangles.push_back(made);
  }
  return coarse;
}

} // namespace patina
