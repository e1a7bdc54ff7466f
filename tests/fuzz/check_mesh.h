// What the readers promise of every mesh that they return.
#pragma once

#include <cstdlib>

#include "geometry/mesh/mesh_report.h"

namespace patina::fuzz {

inline void checkMesh(const TriangleMesh& mesh) {
  const auto vertices = static_cast<std::int32_t>(mesh.positions.size());
  if (mesh.triangles.empty()) std::abort();
  if (!mesh.corner_uvs.empty() && mesh.corner_uvs.size() != mesh.triangles.size()) std::abort();
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t)
      if (v < 0 || v >= vertices) std::abort();
  // The report must cope with whatever was read.
  const MeshReport report = inspect(mesh);
  if (report.non_finite + report.degenerate + report.duplicate > report.triangles) std::abort();
}

} // namespace patina::fuzz
