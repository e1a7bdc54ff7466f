// Neighbourhood of faces and vertices (half-edge structure inside; OpenMesh in the .cpp only).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct Adjacency {
  // Across edge k of a face (from corner k to corner k+1): the other face, or -1 at a boundary or
  // where the edge is non-manifold.
  std::vector<std::array<std::int32_t, 3>> face_neighbours;
  // Faces round each vertex, as offsets into one array: vertex v has faces
  // [vertex_offsets[v], vertex_offsets[v+1]) of vertex_faces.
  std::vector<std::int32_t> vertex_offsets;
  std::vector<std::int32_t> vertex_faces;
};

Adjacency adjacency(const TriangleMesh& mesh);
std::size_t bytes(const Adjacency& adjacency);

} // namespace patina
