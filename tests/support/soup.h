#pragma once

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// The same triangles, none of which shares a vertex.
inline TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto first = static_cast<std::int32_t>(result.positions.size());
    for (int k = 0; k < 3; ++k) result.positions.push_back(mesh.corner(t, k));
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

} // namespace patina
