// Shortest path between two points over a mesh.
#pragma once

#include <optional>
#include <vector>

#include "core/progress.h"
#include "geometry/mesh/adjacency.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct SurfacePath {
  std::vector<Vec3> points; // [m], from the first point to the last, one at each crossed edge
  double length = 0;        // [m]
};

// Finds a path that is straight across every edge and cannot be shortened round any vertex: a
// geodesic of the mesh, exact but for rounding. A search over points on the edges (Lanthier et al.
// 2001) chooses on which side of vertices it begins; each vertex at which the path bends is then
// passed on its other side if that is shorter, with the funnel algorithm (Lee & Preparata 1984) in
// the unfolded faces. Between two geodesics whose lengths differ by less than about 0.1 % it may
// choose the longer one; above 20,000 faces, where fast marching finds the faces to search, by more
// if these are slivers. nullopt if no faces connect the points. Throws Cancelled. Any thread.
std::optional<SurfacePath> geodesicPath(const TriangleMesh& mesh, const Adjacency& neighbours,
                                        const SurfacePoint& from, const SurfacePoint& to,
                                        const Progress& progress = Progress());

// The same without neighbours: these are made for the faces that a path of the found length can
// reach, so that time and memory follow from the distance and not from the size of the mesh.
std::optional<SurfacePath> geodesicPath(const TriangleMesh& mesh, const SurfacePoint& from,
                                        const SurfacePoint& to,
                                        const Progress& progress = Progress());

} // namespace patina
