// What the readers promise of every mesh that they return.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

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

// Each fits on one line.
inline void checkWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& line : warnings)
    for (const char c : line)
      if (static_cast<unsigned char>(c) < 0x20) std::abort();
}

} // namespace patina::fuzz
