// Connected parts of a mesh with their boundary edges, and holes: closed loops of such edges, their
// area and centre.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// A boundary edge of a connected part: an edge with one face.
struct RimEdge {
  std::array<std::int32_t, 2> vertices;
  std::int32_t face;
  int edge;             // from corner `edge` of the face to the next
  bool joined = false;  // a boundary edge of another piece is near
  bool covered = false; // an edge of opposite direction lies along it: a seam, not a boundary
};

struct ConnectedPart {
  std::vector<std::int32_t> faces; // ascending
  std::size_t rim_edges = 0;
  bool joined = false;  // assembled from pieces along their boundaries
  bool twisted = false; // its faces cannot all be made to agree
};

struct ConnectedParts {
  std::vector<ConnectedPart> parts;
  std::vector<std::int32_t> part_of; // part of each face
  std::vector<RimEdge> rims;
  double gap = 0; // largest distance across which pieces are joined [m]
};

// Finds the parts of a welded mesh. A piece is a set of faces connected by edges. Boundary edges of
// two pieces are near each other if their middles are at most 0.7 `reach` apart. A piece takes part
// if half the length of its boundary is near others (three tenths for fewer than four faces). Each
// such edge joins it to the piece of its matching edge or, without one, to all near pieces that
// take part.
ConnectedParts connectedParts(const TriangleMesh& mesh, double reach);

struct Hole {
  double area = 0;            // area of a spanning surface [m^2]
  Vec3 centre = Vec3::Zero(); // centroid of that surface, which may lie off it
  Vec3 on = Vec3::Zero();     // a point in its middle: the centroid of its largest triangle
  std::size_t edges = 0;
};

// Spans a flat loop by its plane and any other by the triangulation of least area (Barequet &
// Sharir 1995) of its vertices, or of 64 of them if there are more.
Hole spanned(const std::vector<Vec3>& loop);

// Returns the loops of edges between `points`, the largest area first. Loops that touch at a vertex
// are separate. Edges that close no loop and holes smaller than `min_area` are left out.
std::vector<Hole> holesOf(const std::vector<Vec3>& points,
                          const std::vector<std::array<std::int32_t, 2>>& edges,
                          double min_area = 0);

// Returns a text like "3600 mm² about (50 mm, 50 mm, 100 mm)".
std::string describeHole(const Hole& hole);

} // namespace patina
