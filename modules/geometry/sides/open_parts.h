// Determines which connected parts of a mesh have an inside and which are open: a terrain, a sheet,
// a scan without a back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/mesh/holes.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/sides/pseudonormal_side.h"
#include "geometry/winding/winding_number.h"

namespace patina {

// Sides of the parts of a mesh that have a boundary. one: only the front, from which the triangles
// run counter-clockwise, is outside; two: both sides are; closed: the part has an inside, and its
// holes are closed. automatic: openParts decides for each part whether it is closed or one-sided;
// automatic_two: closed or two-sided.
enum class OpenSides : std::uint8_t { automatic, one, two, closed, automatic_two };

inline bool decidesItself(OpenSides sides) {
  return sides == OpenSides::automatic || sides == OpenSides::automatic_two;
}
// Applies to open parts.
inline bool haveTwoSides(OpenSides sides) {
  return sides == OpenSides::two || sides == OpenSides::automatic_two;
}

struct PartSides {
  std::size_t triangles = 0;
  std::size_t rim_edges = 0;           // edges with one face
  OpenSides sides = OpenSides::closed; // never automatic
  bool asked = false;                  // decided by the caller, not by openParts
  bool joined = false;                 // assembled from loose pieces along their boundaries
};

struct OpenParts {
  std::vector<std::uint8_t> open;       // 1 for each face of an open part; empty if there is none
  std::size_t parts = 0, triangles = 0; // counts of open parts and their faces
  std::vector<PartSides> decided;       // one a part; empty without boundary edges
  std::vector<FaceEdge> seams;          // edges along which loose pieces of one part meet
  std::vector<Hole> holes;              // holes of closed parts, the largest first
  double gap = 0;                       // widest between joined pieces [m]
  std::size_t inner_triangles = 0;      // left out of a mesh as read, see innerFaces()
  bool any() const { return parts > 0; }
};

// Finds parts: faces connected over edges, with vertices at equal positions merged. Boundaries that
// run along each other for most of their length, at most `reach` [m] apart, connect parts too, so
// that unwelded triangles form one part. 0 disables this.
// automatic: a part is open if it has a boundary (an edge with one face) and neither the winding
// number of the whole mesh nor its own distinguishes front from back on half its area, which
// requires a value at least 0.35 from 1/2 on both sides. It is evaluated near the surface, and up
// to `reach` from it if the part was joined along boundaries. A sphere is open if less than half of
// it is left; a closed scan with holes stays closed, as do loose pieces that enclose a body with
// one orientation.
// Otherwise `sides` holds for every part with a boundary; `two` also for parts without one that
// cannot be oriented (a Klein bottle). All other parts are closed.
//
// Degenerate triangles must be left out, corners be finite. `welded`: the weldedTriangles() of
// `mesh`; `winding`: its winding number. Parallel, and the same for any number of threads.
OpenParts openParts(const TriangleMesh& mesh, const std::vector<Triangle>& welded,
                    const WindingNumber& winding, OpenSides sides, double reach);

// The same for a mesh as read: ignores unusable triangles and inner faces, turns misoriented ones.
OpenParts openParts(const TriangleMesh& mesh, OpenSides sides = OpenSides::automatic,
                    double reach = 0);

struct SideCount {
  const char* sides; // "closed", "one-sided", "two-sided"
  std::size_t triangles;
};
// Lists the kinds of triangles that a mesh has.
std::vector<SideCount> sideCounts(std::size_t triangles, std::size_t open_triangles,
                                  OpenSides sides);
std::string describeSides(const std::vector<SideCount>& counts);

const char* sideName(OpenSides sides); // "closed", "one-sided" or "two-sided"
// Returns a text like "2 parts two-sided as asked, 1 part closed by the program".
std::string describeParts(const std::vector<PartSides>& parts);

} // namespace patina
