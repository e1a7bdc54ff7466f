// Paths of a tip, and the boundaries that they cross.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "app/studies/contact/contact_trials.h"

namespace patina::test {

// Returns positions along the polyline at one speed [m/s], one per tick.
inline std::vector<Vec3> way(const std::vector<Vec3>& corners, double speed) {
  std::vector<Vec3> tips = {corners.front()};
  for (const Vec3& to : corners) {
    const Vec3 from = tips.back();
    const int count = static_cast<int>(std::ceil((to - from).norm() / (speed * kTick)));
    for (int i = 1; i <= count; ++i)
      tips.push_back(from + static_cast<double>(i) / count * (to - from));
  }
  return tips;
}

// Both ends of edges with one face.
inline std::vector<std::pair<Vec3, Vec3>> rims(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> faces;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++faces[std::minmax({t[k], t[(k + 1) % 3]})];
  std::vector<std::pair<Vec3, Vec3>> rim;
  for (const auto& [edge, count] : faces)
    if (count == 1)
      rim.emplace_back(mesh.positions[static_cast<std::size_t>(edge.first)],
                       mesh.positions[static_cast<std::size_t>(edge.second)]);
  return rim;
}

} // namespace patina::test
