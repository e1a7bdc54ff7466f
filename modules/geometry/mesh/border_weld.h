// Closes the cracks of a mesh for its report: corners that lie in one place, or nearly so, and
// corners that lie on an edge. Internal to mesh_report.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/types.h"

namespace patina {

// An edge that one face uses, in the direction of that face.
struct BoundaryEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
};

struct BorderWeld {
  std::vector<std::int32_t> vertex_of; // by vertex, the one that it is welded to; empty if none is
  double widest_crack = 0;             // greatest distance between two welded corners
};

// Welds vertices of the border at equal positions.
BorderWeld weldBorder(const std::vector<Vec3>& positions, const std::vector<BoundaryEdge>& border);
// Welds vertices of the border that are at most `tolerance` and a quarter of the shortest border
// edge at either of them apart.
BorderWeld weldBorder(const std::vector<Vec3>& positions, const std::vector<BoundaryEdge>& border,
                      double tolerance);

struct SplitBorder {
  std::vector<BoundaryEdge> edges;
  double widest_crack = 0; // greatest distance of a corner from the edge that it splits
};
// Splits edges of the border at its vertices that lie on them within `tolerance` (T-junctions).
SplitBorder splitBorder(const std::vector<Vec3>& positions, const std::vector<BoundaryEdge>& border,
                        double tolerance);

} // namespace patina
