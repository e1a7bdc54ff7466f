// Which connected parts of a mesh have an inside, and which are open: a terrain, a sheet, a scan
// without a back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"
#include "geometry/winding/winding_number.h"

namespace patina {

// What an open part of a mesh is to the touch. one: its front, the side from which its triangles
// run counter-clockwise, is outside; two: both sides are.
enum class OpenSides : std::uint8_t { one, two };

struct OpenParts {
  std::vector<std::uint8_t> open;       // by face: 1 = of an open part; empty if there is none
  std::size_t parts = 0, triangles = 0; // that are open
  bool any() const { return parts > 0; }
};

// Parts are connected over edges, vertices at equal positions being one. A part is open if it has a
// rim (an edge with one face) and neither the winding number of the whole mesh nor its own tells
// its front from its back over half its area: on both sides it would have to be 0.35 off 1/2. A
// sphere is open from where less than half of it is there. So a closed scan with holes stays
// closed, and so do loose pieces that close a body together: they all face out of it, or into it.
// Degenerate triangles must be left out, corners be finite. `winding`: of `mesh`. Parallel, and the
// same for any number of threads.
OpenParts openParts(const TriangleMesh& mesh, const WindingNumber& winding);

// The same for a mesh as read: unusable triangles count nowhere, misoriented ones are turned.
OpenParts openParts(const TriangleMesh& mesh);

struct SideCount {
  const char* sides; // "closed", "one-sided", "two-sided"
  std::size_t triangles;
};
// What a mesh consists of, for people; kinds that it has none of are left out.
std::vector<SideCount> sideCounts(std::size_t triangles, std::size_t open_triangles,
                                  OpenSides sides);
std::string describeSides(const std::vector<SideCount>& counts);

} // namespace patina
