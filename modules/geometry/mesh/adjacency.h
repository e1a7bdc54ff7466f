// Neighbours of faces and vertices (OpenMesh half-edges inside the .cpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct Adjacency {
  // Face across edge k (from corner k to corner k + 1), or -1 at a boundary or non-manifold edge.
  std::vector<std::array<std::int32_t, 3>> face_neighbours;
  // Faces round each vertex: vertex v has faces [vertex_offsets[v], vertex_offsets[v + 1]) of
  // vertex_faces.
  std::vector<std::int32_t> vertex_offsets;
  std::vector<std::int32_t> vertex_faces;
};

Adjacency adjacency(const TriangleMesh& mesh);
std::size_t bytes(const Adjacency& adjacency);

} // namespace patina
