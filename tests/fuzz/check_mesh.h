// Checks the readers' contract for every mesh that they return.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "geometry/mesh/mesh_colors.h"
#include "geometry/mesh/mesh_report.h"

namespace patina::fuzz {

inline void checkMesh(const TriangleMesh& mesh) {
  const auto vertices = static_cast<std::int32_t>(mesh.positions.size());
  if (mesh.triangles.empty()) std::abort();
  if (!mesh.corner_uvs.empty() && mesh.corner_uvs.size() != mesh.triangles.size()) std::abort();
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t)
      if (v < 0 || v >= vertices) std::abort();
  // The report must handle any mesh that was read.
  const MeshReport report = inspect(mesh);
  if (report.non_finite + report.degenerate + report.duplicate > report.triangles) std::abort();
}

// Each list is absent or belongs to the mesh; every value is in [0, 1].
inline void checkColors(const MeshColors& colors, const TriangleMesh& mesh) {
  if (!colors.vertices.empty() && colors.vertices.size() != mesh.positions.size()) std::abort();
  if (!colors.faces.empty() && colors.faces.size() != mesh.triangles.size()) std::abort();
  for (const auto* list : {&colors.vertices, &colors.faces})
    for (const Rgba& color : *list)
      for (const float value : color)
        if (!(value >= 0 && value <= 1)) std::abort();
  if (colors.picture_of.empty()) return;
  if (colors.picture_of.size() != mesh.triangles.size() || mesh.corner_uvs.empty()) std::abort();
  for (const std::int32_t picture : colors.picture_of)
    if (picture < -1 || picture >= static_cast<std::int32_t>(colors.pictures.size())) std::abort();
}

// Each fits on one line.
inline void checkWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& line : warnings)
    for (const char c : line)
      if (static_cast<unsigned char>(c) < 0x20) std::abort();
}

} // namespace patina::fuzz
