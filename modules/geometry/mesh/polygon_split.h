// Splits polygons into triangles for the mesh readers.
#pragma once

#include <string>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// A face with more than three corners, stored as the fan (0, k, k + 1) of its corners.
struct PolygonFan {
  std::size_t first_triangle = 0;
  std::size_t corners = 0;
};

struct PolygonFaults {
  std::size_t crossing = 0; // polygons whose outline crosses itself
  std::size_t too_long = 0; // polygons with more corners than the split handles; they stay fans
};

// Replaces each fan by as many triangles that keep the polygon's outline (ear clipping, Meisters
// 1975). A flat polygon whose fan is valid keeps it bit for bit. In a non-flat polygon inner edges
// are flipped to reduce the folds; the result does not depend on the first corner. Polygons without
// area or with non-finite corners stay fans.
PolygonFaults splitPolygons(TriangleMesh& mesh, const std::vector<PolygonFan>& fans);

// One line for each kind of fault.
void addPolygonWarnings(const PolygonFaults& faults, std::vector<std::string>& warnings);

} // namespace patina
