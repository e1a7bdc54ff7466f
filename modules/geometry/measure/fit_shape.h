// Patches of a mesh, and spheres and cylinders through their vertices.
#pragma once

#include <optional>
#include <vector>

#include "geometry/mesh/adjacency.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

struct MeshPatch {
  std::vector<std::int32_t> faces;
  std::vector<Vec3> points; // vertices of the faces, each once [m]
};

// Returns the faces that are connected with the point's face, come within `radius` [m] of the point
// and meet at less than 35°, so that the patch ends at creases.
MeshPatch patchAround(const TriangleMesh& mesh, const Adjacency& neighbours,
                      const SurfacePoint& point, double radius);

struct FittedSphere {
  Vec3 centre = Vec3::Zero();
  double radius = 0; // [m]
  double rms = 0;    // rms of the points' distances from it [m]
};

struct FittedCylinder {
  Vec3 centre = Vec3::Zero(); // on the axis, nearest to the points' mean
  Vec3 axis = Vec3::UnitZ();  // unit
  double radius = 0, rms = 0; // see FittedSphere
};

// Least squares of the distances (Gauss-Newton). nullopt: fewer than 4 points, or a plane.
std::optional<FittedSphere> fitSphere(const std::vector<Vec3>& points);
// The same; the normals of the patch's faces give the first axis. nullopt: fewer than 6 points, or
// no curvature.
std::optional<FittedCylinder> fitCylinder(const TriangleMesh& mesh, const MeshPatch& patch);

} // namespace patina
