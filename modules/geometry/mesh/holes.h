// Holes of a mesh: closed loops of edges with one face, their area and place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types.h"

namespace patina {

struct Hole {
  double area = 0;            // of a surface that spans it [m^2]
  Vec3 centre = Vec3::Zero(); // centroid of that surface
  std::size_t edges = 0;
};

// The surface that spans a flat loop is flat; any other has the triangulation of least area of the
// loop's vertices (Barequet and Sharir, 1995), of 64 of them if there are more.
Hole spanned(const std::vector<Vec3>& loop);

// Loops of the edges between `points`, the largest area first. Where loops touch at a vertex each
// is one by itself. Edges that close no loop are left out, and holes of less than `least_area`.
std::vector<Hole> holesOf(const std::vector<Vec3>& points,
                          const std::vector<std::array<std::int32_t, 2>>& edges,
                          double least_area = 0);

// "3600 mm² about (50 mm, 50 mm, 100 mm)".
std::string describeHole(const Hole& hole);

} // namespace patina
