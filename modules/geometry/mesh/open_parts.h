// Which connected parts of a mesh have an inside, and which are open: a terrain, a sheet, a scan
// without a back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/mesh/front_side.h"
#include "geometry/mesh/holes.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/winding/winding_number.h"

namespace patina {

// What the parts of a mesh that have a rim are to the touch. one: the front, the side from which
// the triangles run counter-clockwise, is outside; two: both sides are; closed: the part has an
// inside, and its holes are closed over. automatic: openParts decides for each part whether it is
// closed or one-sided; automatic_two: closed or two-sided.
enum class OpenSides : std::uint8_t { automatic, one, two, closed, automatic_two };

inline bool decidesItself(OpenSides sides) {
  return sides == OpenSides::automatic || sides == OpenSides::automatic_two;
}
// Of open parts.
inline bool haveTwoSides(OpenSides sides) {
  return sides == OpenSides::two || sides == OpenSides::automatic_two;
}

struct PartSides {
  std::size_t triangles = 0;
  std::size_t rim_edges = 0;           // edges with one face
  OpenSides sides = OpenSides::closed; // never automatic
  bool asked = false;                  // the caller decided, not openParts
  bool joined = false;                 // of loose pieces, by their rims
};

struct OpenParts {
  std::vector<std::uint8_t> open;       // by face: 1 = of an open part; empty if there is none
  std::size_t parts = 0, triangles = 0; // that are open
  std::vector<PartSides> decided;       // by part; empty if no edge of the mesh has one face
  std::vector<FaceEdge> seams;          // where loose pieces of one part meet
  std::vector<Hole> holes;              // of closed parts, the largest first
  std::size_t inner_triangles = 0;      // left out of a mesh as read (innerFaces)
  bool any() const { return parts > 0; }
};

// Parts are connected over edges, vertices at equal positions being one. Rims that run along each
// other at most `reach` [m] apart connect parts, too, where they are most of both rims: so loose
// triangles that nobody has welded are one part. 0 connects none.
//
// automatic: a part is open if it has a rim (an edge with one face) and neither the
// winding number of the whole mesh nor its own tells its front from its back over half its area:
// on both sides it would have to be 0.35 off 1/2. Near the surface, and up to `reach` from it where
// rims connect the part. A sphere is open from where less than half of it is there. So a closed
// scan with holes stays closed, and so do loose pieces that close a body together: they all face
// out of it, or into it.
// Otherwise `sides` holds for every part with a rim; `two` also for parts without one whose faces
// cannot be turned to agree (a Klein bottle). All other parts are closed.
//
// Degenerate triangles must be left out, corners be finite. `winding`: of `mesh`. Parallel, and the
// same for any number of threads.
OpenParts openParts(const TriangleMesh& mesh, const WindingNumber& winding,
                    OpenSides sides = OpenSides::automatic, double reach = 0);

// The same for a mesh as read: unusable triangles and inner faces count nowhere, misoriented ones
// are turned.
OpenParts openParts(const TriangleMesh& mesh, OpenSides sides = OpenSides::automatic,
                    double reach = 0);

struct SideCount {
  const char* sides; // "closed", "one-sided", "two-sided"
  std::size_t triangles;
};
// What a mesh consists of, for people; kinds that it has none of are left out.
std::vector<SideCount> sideCounts(std::size_t triangles, std::size_t open_triangles,
                                  OpenSides sides);
std::string describeSides(const std::vector<SideCount>& counts);

const char* sideName(OpenSides sides); // "closed", "one-sided" or "two-sided"
// "2 parts two-sided as asked, 1 part closed by the program".
std::string describeParts(const std::vector<PartSides>& parts);

} // namespace patina
