// A triangle mesh as plain arrays.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/types.h"

namespace patina {

using Triangle =
    std::array<std::int32_t, 3>; // indices into positions, counter-clockwise from outside

struct TriangleMesh {
  std::vector<Vec3> positions; // [m] once its unit has been applied (see geometry/mesh/mesh_unit.h)
  std::vector<Triangle> triangles;
  std::vector<std::array<Vec2, 3>> corner_uvs; // empty, or one entry a triangle

  Vec3 corner(std::size_t triangle, int which) const {
    return positions[static_cast<std::size_t>(
        triangles[triangle][static_cast<std::size_t>(which)])];
  }
};

// A point on a mesh: the common currency of contact, paint, texture and registration.
struct SurfacePoint {
  std::int32_t face = -1; // -1 = none
  Vec3 barycentric = Vec3::Zero();
};

Box3 bounds(const TriangleMesh& mesh); // bounds of the used vertices; empty if there are none
Vec3 position(const TriangleMesh& mesh, const SurfacePoint& point);
Vec3 faceNormal(const TriangleMesh& mesh, std::size_t triangle); // unit; zero if degenerate
double area(const TriangleMesh& mesh);
// Signed, by the divergence theorem; meaningful for closed meshes only.
double volume(const TriangleMesh& mesh);
// A reflection also reverses the triangles, so that the outside stays outside.
TriangleMesh transformed(const TriangleMesh& mesh, const Eigen::Affine3d& target_from_mesh);
// Appends the triangles of `other`; texture coordinates remain only if both have them.
void append(TriangleMesh& mesh, const TriangleMesh& other);
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);
// Keeps the vertices that triangles use, in their order.
void removeUnusedVertices(TriangleMesh& mesh);

} // namespace patina
