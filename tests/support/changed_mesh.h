// A mesh moved or turned inside out.
#pragma once

#include <utility>

#include "geometry/mesh/triangle_mesh.h"

namespace patina::test {

inline TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.positions) p += by;
  return mesh;
}

inline TriangleMesh inverted(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

} // namespace patina::test
