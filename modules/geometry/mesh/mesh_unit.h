// Meshes carry no unit, and some have y upwards; this gives them metres and z.
#pragma once

#include <string>
#include <string_view>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

enum class MeshUnit { mm, cm, m, in, fit }; // fit: longest side becomes 100 mm

MeshUnit parseMeshUnit(std::string_view text); // throws Error naming the choices
std::string_view name(MeshUnit unit);

// In which a mesh of this longest side, in its own units, would be 32 to 316 mm long: what a hand can
// feel. Metric; fit where there is none.
MeshUnit likelyUnit(double longest);

enum class UpAxis { z, y }; // of the program that wrote the file

UpAxis parseUpAxis(std::string_view text); // throws Error naming the choices
// Turned about x so that what was up is z.
TriangleMesh zUp(TriangleMesh mesh, UpAxis up);

// [m] from the origin, along an axis. Areas are squared: the fourth power of a length must be a
// double, and distances lose their signs from 1e77 on.
inline constexpr double kFarthestCorner = 1e75;

struct ScaledMesh {
  TriangleMesh mesh;   // [m]
  double scale = 1;    // metres a file unit
  std::string warning; // empty, or one line if the result is < 1 mm or > 2 m; names --unit
};
// Throws Error where a finite corner would lie beyond kFarthestCorner.
ScaledMesh inMetres(TriangleMesh mesh, MeshUnit unit);

} // namespace patina
