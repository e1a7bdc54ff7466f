// A mesh as triangles without shared corners, each slightly displaced.
#pragma once

#include <random>

#include "geometry/mesh/triangle_mesh.h"

namespace patina::test {

// Shifts every triangle by `shift` [m] in a direction of its own; with `corners` every corner.
inline TriangleMesh loose(const TriangleMesh& mesh, double shift, bool corners = false) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto step = [&]() -> Vec3 {
    const double x = normal(random), y = normal(random), z = normal(random);
    return shift * Vec3(x, y, z).normalized();
  };
  TriangleMesh result;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto first = static_cast<std::int32_t>(result.positions.size());
    Vec3 by = step();
    for (int k = 0; k < 3; ++k) {
      if (corners) by = step();
      result.positions.push_back(mesh.corner(t, k) + by);
    }
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

} // namespace patina::test
