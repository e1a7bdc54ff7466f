// Texture coordinates of a mesh's faces along a scan's path (A12 to A16).
#pragma once

#include "geometry/mesh/adjacency.h"
#include "geometry/mesh/textured_face.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

// A mesh for queries by several paths.
struct MeshQuery {
  explicit MeshQuery(TriangleMesh given)
      : mesh(std::move(given)), tree(mesh), neighbours(adjacency(mesh)) {}
  TriangleMesh mesh; // [m], all faces finite
  TriangleTree tree;
  Adjacency neighbours;
};

// A path on or near a mesh, in its frame.
struct PathOnMesh {
  std::vector<Vec3> points;       // [m]
  std::vector<double> arc_length; // given arc length [m]; empty: computed
};

// Returns the faces nearest to the path, ascending. Where the faces of neighbouring points share no
// edge, points in between are queried down to 1e-6 of the mesh's size. path: at least two points on
// or near the mesh [m].
std::vector<std::int32_t> facesUnder(const MeshQuery& ground, const std::vector<Vec3>& path);

enum class Neighbours { by_vertex, by_edge };
// Returns `faces` and `rings` rings of their neighbours (A13), ascending.
std::vector<std::int32_t> withRings(const MeshQuery& ground, const std::vector<std::int32_t>& faces,
                                    int rings, Neighbours neighbours = Neighbours::by_vertex);

// Coordinates by the closest point of a path's polyline: x is its arc length [m], y the distance,
// positive to the left when looking along the path from outside the surface. The path continues
// straight beyond its ends.
struct PathCoordinates {
  // Faces without coordinates, counted once by the first reason that applies.
  std::size_t folded = 0;          // x decreases or is undefined: beyond the center of a bend
  std::size_t ambiguous = 0;       // corners belong to different parts of the path
  std::size_t stretched = 0;       // x and y stretch by more than `max_stretch`
  std::vector<TexturedFace> faces; // ascending
  double length = 0;               // length of the path [m]
  double max_stretch = 0, min_stretch = 0; // stretch along x of the kept faces; 0 without any
};

struct CoordinateOptions {
  std::int32_t texture = 0; // texture number of the faces
  double max_stretch = 2;
};

// Computes the coordinates of these faces. Each face uses the part of the path nearest to its
// middle, so that parts meet in seams between faces and do not warp a face. Repeated points are
// left out. Throws Error for a path without length, and if `arc_length` decreases or has another
// size than the points.
PathCoordinates pathCoordinates(const MeshQuery& ground, const std::vector<std::int32_t>& faces,
                                const PathOnMesh& path, const CoordinateOptions& options);

} // namespace patina
