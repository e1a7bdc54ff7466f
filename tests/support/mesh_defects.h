// Deliberate defects of a mesh. The same seed gives the same mesh.
#pragma once

#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Reverses each face with probability `fraction`.
inline TriangleMesh withFlippedFaces(const TriangleMesh& mesh, double fraction, unsigned seed) {
  TriangleMesh result = mesh;
  std::mt19937 random(seed);
  // Not std::bernoulli_distribution: its sequence differs between standard libraries.
  const double limit = fraction * 4294967296.0;
  for (std::size_t t = 0; t < result.triangles.size(); ++t)
    if (static_cast<double>(random()) < limit) {
      std::swap(result.triangles[t][1], result.triangles[t][2]);
      if (!result.corner_uvs.empty()) std::swap(result.corner_uvs[t][1], result.corner_uvs[t][2]);
    }
  return result;
}

// Removes the faces with a corner within `radius` of one of `holes` random vertices.
inline TriangleMesh withHoles(const TriangleMesh& mesh, int holes, double radius, unsigned seed) {
  if (mesh.triangles.empty() && holes > 0)
    throw std::invalid_argument("withHoles: the mesh has no triangles");
  std::mt19937 random(seed);
  std::vector<Vec3> centres;
  for (int h = 0; h < holes; ++h) {
    const std::size_t triangle = random() % mesh.triangles.size();
    centres.push_back(mesh.corner(triangle, static_cast<int>(random() % 3)));
  }
  std::vector<bool> cut(mesh.positions.size(), false);
  for (std::size_t v = 0; v < cut.size(); ++v)
    for (const Vec3& centre : centres)
      if ((mesh.positions[v] - centre).norm() <= radius) cut[v] = true;

  TriangleMesh result;
  std::vector<std::int32_t> index_of(mesh.positions.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle triangle = mesh.triangles[t];
    bool keep = true;
    for (const std::int32_t v : triangle) keep = keep && !cut[static_cast<std::size_t>(v)];
    if (!keep) continue;
    for (std::int32_t& v : triangle) {
      std::int32_t& index = index_of[static_cast<std::size_t>(v)];
      if (index < 0) {
        index = static_cast<std::int32_t>(result.positions.size());
        result.positions.push_back(mesh.positions[static_cast<std::size_t>(v)]);
      }
      v = index;
    }
    result.triangles.push_back(triangle);
    if (!mesh.corner_uvs.empty()) result.corner_uvs.push_back(mesh.corner_uvs[t]);
  }
  return result;
}

} // namespace patina
