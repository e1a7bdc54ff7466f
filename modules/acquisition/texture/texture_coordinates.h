// Where along a scan's path, and how far beside it, the corners of a mesh's faces lie: what lays a
// texture onto them (A12 to A16).
#pragma once

#include "geometry/mesh/adjacency.h"
#include "geometry/mesh/textured_face.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

// A mesh that paths are laid onto; made once for all of them.
struct PathGround {
  explicit PathGround(TriangleMesh given)
      : mesh(std::move(given)), tree(mesh), neighbours(adjacency(mesh)) {}
  TriangleMesh mesh; // [m], all faces finite
  TriangleTree tree;
  Adjacency neighbours;
};

// A path on or near a mesh, in its frame.
struct PathOnMesh {
  std::vector<Vec3> points; // [m]
  // How far along each lies, as whoever measured a profile over it says [m]; empty: the way itself.
  std::vector<double> along;
};

// The faces nearest to the path's points and to what lies between them: a point a quarter of the
// way is looked at wherever two neighbours' faces share no edge, down to 1e-6 of the mesh's size.
// Ascending. path: two points or more, each on or near the mesh [m].
std::vector<std::int32_t> facesUnder(const PathGround& ground, const std::vector<Vec3>& path);

enum class Neighbours { by_vertex, by_edge };
// `faces` and their neighbours, theirs and so on, `rings` times (A13). Ascending.
std::vector<std::int32_t> withRings(const PathGround& ground,
                                    const std::vector<std::int32_t>& faces, int rings,
                                    Neighbours neighbours = Neighbours::by_vertex);

// From a path's polyline: x is how far along it the nearest point lies [m], y the distance,
// positive to the left of who walks along it with the surface under the feet. Before the first
// point and behind the last it goes on straight.
struct PathCoordinates {
  // None of `face` is counted twice: the first of these that holds is why it got none.
  std::size_t folded = 0;    // x runs backwards, or nowhere: behind the centre of a bend
  std::size_t ambiguous = 0; // its corners belong to different parts of the path
  std::size_t stretched = 0; // x and y grow more than `most_stretch` times the way over the face
  std::vector<TexturedFace> faces; // ascending
  double length = 0;               // of the path [m]
  double most = 0, least = 0;      // stretch along x over a kept face; 0 where none is kept
};

struct CoordinateOptions {
  std::int32_t texture = 0; // that the faces are given
  double most_stretch = 2;
};

// Coordinates of these faces. Each face takes the part of the path that is nearest to its middle,
// so that where two parts meet there is a seam between faces and no warp within one. Points that
// repeat are left out. Throws Error for a path without length, and for one whose `along` falls or
// is not one a point.
PathCoordinates pathCoordinates(const PathGround& ground, const std::vector<std::int32_t>& faces,
                                const PathOnMesh& path, const CoordinateOptions& options);

} // namespace patina
