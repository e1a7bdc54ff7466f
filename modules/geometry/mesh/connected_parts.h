// The connected parts of a mesh and their rims. Internal to open_parts.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct RimEdge { // an edge with one face
  std::array<std::int32_t, 2> vertices;
  std::int32_t face;
  int edge;             // from corner `edge` of the face to the next
  bool joined = false;  // a rim of another piece is near
  bool covered = false; // one that runs the other way lies along it: a seam, not a rim
};

struct ConnectedPart {
  std::vector<std::int32_t> faces; // ascending
  std::size_t rim_edges = 0;
  bool joined = false;  // made of pieces by their rims
  bool twisted = false; // faces beside each other do not agree: they cannot, if they were turned
};

struct ConnectedParts {
  std::vector<ConnectedPart> parts;
  std::vector<std::int32_t> part_of; // by face
  std::vector<RimEdge> rims;
};

// `mesh`: welded. A piece is what edges connect. A rim edge is near another piece if the middle of
// one of its rim edges is at most 0.7 `reach` away. A piece takes part where that holds for half of
// its rim's length (three tenths, of a piece of less than four faces), and is joined to the pieces
// whose rims lie along its own; where none does, to all that are near.
ConnectedParts connectedParts(const TriangleMesh& mesh, double reach);

} // namespace patina
