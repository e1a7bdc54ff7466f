// The winding number by its definition.
#pragma once

#include <cmath>
#include <numbers>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Exact sum over all triangles, coincident ones included.
inline double windingNumberBruteForce(const TriangleMesh& mesh, const Vec3& p) {
  double total = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0) - p;
    const Vec3 b = mesh.corner(t, 1) - p;
    const Vec3 c = mesh.corner(t, 2) - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    total +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return total / (2 * std::numbers::pi);
}

} // namespace patina
