// Counts the defects of a mesh and removes its unusable triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Fraction of the longest side of a mesh's bounds. Boundary corners no farther apart, and no
// farther than a quarter of the shortest boundary edge at them, count as one in the report. Corners
// at equal positions always do, so that it does not matter whether touching bodies share vertices.
inline constexpr double kWeldTolerance = 1e-3;

struct MeshReport {
  std::size_t triangles = 0;
  std::size_t vertices = 0;
  std::size_t components = 0; // connected through corners, after the repairs listed under edges
  bool watertight = false;    // every edge has two faces of opposite edge direction
  // Largest distance between corners, or between a corner and an edge, that count as joined; in the
  // mesh's unit.
  double widest_crack = 0;
  // Triangles:
  std::size_t non_finite = 0; // a corner is NaN or infinite
  // Twice the area is at most 1e-12 of the longest edge squared, or a vertex is repeated.
  std::size_t degenerate = 0;
  std::size_t duplicate = 0; // same three corners as an earlier triangle (in any order)
  // Edges, after the triangles above are left out and the cracks at the border are closed:
  std::size_t boundary_edges = 0;     // one face
  std::size_t non_manifold_edges = 0; // three or more
  std::size_t misoriented_edges = 0;  // two faces of equal edge direction
};

MeshReport inspect(const TriangleMesh& mesh);

// Returns the triangles that are neither non-finite nor degenerate, ascending.
std::vector<std::int32_t> usableTriangles(const TriangleMesh& mesh);

struct CleanMesh {
  TriangleMesh mesh;   // without non-finite and degenerate triangles; unused vertices removed
  MeshReport report;   // describes the mesh as given
  std::size_t dropped; // non_finite + degenerate
};
// Removes unusable triangles. Keeps duplicate and misoriented faces, which distances and signs
// tolerate. Throws Error if no triangle is left.
CleanMesh cleaned(TriangleMesh mesh);

} // namespace patina
