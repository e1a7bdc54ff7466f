// Triangulates the surface phi = iso of a field by marching cubes (Lorensen & Cline 1987).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "field/store/surface_field.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Marching cubes table (Lorensen & Cline 1987): the surface in one cell for each of the 256
// patterns of inside corners. It is derived: on every face segments join the crossed edges so that
// inside corners are separated, which depends only on that face, so that neighbouring cells agree;
// the segments form loops, and the loops become triangles.

// Edge of a cell: from corner (x, y, z) of {0, 1}^3 one step along `axis`.
struct CellEdge {
  std::int8_t x, y, z, axis;
};
inline constexpr int kCellEdges = 12;
extern const std::array<CellEdge, kCellEdges> kCellEdge;

struct MarchingCubesCase {
  std::uint8_t count = 0; // triangles
  // Edge indices; counter-clockwise as seen from outside.
  std::array<std::array<std::uint8_t, 3>, 6> triangle{};
};

// Bit x + 2 y + 4 z of the index is set if that corner is inside.
const std::array<MarchingCubesCase, 256>& marchingCubesCases();

// Returns the loops of which a case's triangles consist; for tests.
std::vector<std::vector<int>> isoLoops(unsigned inside);
// Returns true if both edges border one face of the cell: a diagonal between them would lie in that
// face and could meet the neighbour's.
bool shareFace(int edge_a, int edge_b);

// Returns a welded mesh of all blocks, closed if the iso-surface stays inside the band, in slot
// order and bitwise the same for any number of threads. iso in metres, |iso| < band. Faces outwards
// (towards growing phi). Cells with a node beyond the band are left out: with |iso| <= band - 2
// voxels none of them holds the surface. Vertex error O(h^2), because phi is taken as linear along
// an edge. Throws invalid_argument for another iso. Parallel.
TriangleMesh isoSurface(const SurfaceField& field, double iso);

} // namespace patina
