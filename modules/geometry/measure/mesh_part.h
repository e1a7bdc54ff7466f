// Part of a mesh near two points, so that a measurement on a large mesh costs what its surroundings
// cost.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct MeshPart {
  TriangleMesh mesh;              // positions and triangles only
  std::vector<std::int32_t> face; // face of the whole mesh for each face, ascending
};

MeshPart partOf(const TriangleMesh& mesh, std::vector<std::int32_t> faces); // ascending

// Returns at least the faces that have a point p with |p - a| + |p - b| <= longest [m], an
// ellipsoid with foci a and b: no path of that length from a to b leaves it.
MeshPart partWithin(const TriangleMesh& mesh, const Vec3& a, const Vec3& b, double longest);

// Returns a point of the whole mesh as one of the part, whose face it must be.
SurfacePoint pointOfPart(const MeshPart& part, const SurfacePoint& point);

} // namespace patina
