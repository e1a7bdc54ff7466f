// Lists the faces at each edge, with vertices at equal positions merged. Internal to geometry.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"
#include "geometry/mesh/vertex_weld.h"

namespace patina {

// Returns the same triangles over merged points, which keep the order of their first use.
inline TriangleMesh weldedMesh(const TriangleMesh& mesh) {
  VertexWeld weld(mesh.positions.size());
  std::vector<std::int32_t> vertex;
  vertex.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) vertex.push_back(weld.index(p));
  TriangleMesh result{weld.takePoints(), mesh.triangles, {}};
  for (Triangle& t : result.triangles)
    for (std::int32_t& v : t) v = vertex[static_cast<std::size_t>(v)];
  return result;
}

inline std::vector<Triangle> weldedTriangles(const TriangleMesh& mesh) {
  return weldedMesh(mesh).triangles;
}

// Returns for each face the lowest face with the same three vertices, which may be itself.
inline std::vector<std::int32_t> firstDuplicates(const std::vector<Triangle>& triangles) {
  struct Named {
    Triangle vertices;
    std::int32_t face;
    auto operator<=>(const Named&) const = default;
  };
  std::vector<Named> sorted;
  sorted.reserve(triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    sorted.push_back({triangles[f], static_cast<std::int32_t>(f)});
    std::sort(sorted.back().vertices.begin(), sorted.back().vertices.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::int32_t> first(triangles.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool twin = i > 0 && sorted[i].vertices == sorted[i - 1].vertices;
    first[static_cast<std::size_t>(sorted[i].face)] =
        twin ? first[static_cast<std::size_t>(sorted[i - 1].face)] : sorted[i].face;
  }
  return first;
}

struct EdgeUse {
  std::int32_t low, high, face;
  int edge; // from corner `edge` of the face to the next
  auto operator<=>(const EdgeUse&) const = default;
};

// Calls visit(first, last) for the uses of each edge. Duplicates of an earlier face do not count.
template <class Uses, class Visit>
void forEachEdge(const std::vector<Triangle>& triangles, const std::vector<std::int32_t>& twin,
                 const Uses& counts, const Visit& visit) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const auto face = static_cast<std::int32_t>(f);
    if (twin[f] != face || !counts(f)) continue;
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = triangles[f][static_cast<std::size_t>(k)];
      const std::int32_t b = triangles[f][static_cast<std::size_t>((k + 1) % 3)];
      uses.push_back({std::min(a, b), std::max(a, b), face, k});
    }
  }
  std::sort(uses.begin(), uses.end());
  for (auto first = uses.begin(); first != uses.end();) {
    auto last = first + 1;
    while (last != uses.end() && last->low == first->low && last->high == first->high) ++last;
    visit(first, last);
    first = last;
  }
}

} // namespace patina
