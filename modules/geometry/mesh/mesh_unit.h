// Converts meshes, which carry no unit and may have y upwards, to metres with z upwards.
#pragma once

#include <string>
#include <string_view>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

enum class MeshUnit { mm, cm, m, in, fit }; // fit: the longest side becomes 100 mm

MeshUnit parseMeshUnit(std::string_view text); // throws Error naming the choices
std::string_view name(MeshUnit unit);

// Returns the metric unit in which a mesh of this longest side would be 32 to 316 mm long, or fit
// if there is none.
MeshUnit likelyUnit(double longest);

enum class UpAxis { z, y }; // vertical axis in the file

UpAxis parseUpAxis(std::string_view text); // throws Error naming the choices
// Rotates about x so that the vertical axis becomes z.
TriangleMesh zUp(TriangleMesh mesh, UpAxis up);

// Largest accepted coordinate [m]. Squared areas, the fourth power of a length, must stay finite,
// and distances lose their signs from 1e77 on.
inline constexpr double kMaxCoordinate = 1e75;

struct ScaledMesh {
  TriangleMesh mesh;   // [m]
  double scale = 1;    // metres per file unit
  std::string warning; // empty, or one line if the result is < 1 mm or > 2 m; names --unit
};
// Returns true from 1 mm to 2 m: others are probably read in a wrong unit.
bool isUsualLength(double metres);
// Throws Error if a finite corner would lie beyond kMaxCoordinate.
ScaledMesh inMetres(TriangleMesh mesh, MeshUnit unit);

} // namespace patina
