// How a surface passes through one cell, for each of the 256 patterns of nodes inside it. The table
// is derived, not listed: on every face the crossed edges are joined so that inside corners are
// kept apart, which depends on that face alone, so that two cells always agree; the segments close
// to loops, and the loops become triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace patina {

// Edge of a cell: from corner (x, y, z) of {0, 1}^3 one step along `axis`.
struct CellEdge {
  std::int8_t x, y, z, axis;
};
inline constexpr int kCellEdges = 12;
extern const std::array<CellEdge, kCellEdges> kCellEdge;

struct IsoCase {
  std::uint8_t count = 0; // triangles
  // Edge numbers; counter-clockwise as seen from outside.
  std::array<std::array<std::uint8_t, 3>, 6> triangle{};
};

// Bit x + 2 y + 4 z of the index is set where that corner is inside.
const std::array<IsoCase, 256>& isoCases();

// The loops from which a case's triangles are made; for tests.
std::vector<std::vector<int>> isoLoops(unsigned inside);
// Whether both edges border one face of the cell: a diagonal between them would lie in that face
// and could meet the neighbour's.
bool shareFace(int edge_a, int edge_b);

} // namespace patina
