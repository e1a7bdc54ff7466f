#include "geometry/sides/pseudonormal_side.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh/edge_uses.h"
#include "geometry/mesh/vertex_weld.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {
PseudonormalSide::PseudonormalSide(const TriangleMesh& mesh, const std::vector<std::uint8_t>& open,
                                   const std::vector<FaceEdge>& seams)
    : mesh_(mesh), vertices_(weldedTriangles(mesh)), first_duplicate_(firstDuplicates(vertices_)),
      corners_(mesh.positions.size()), edge_of_(vertices_.size()) {
  for (std::size_t f = 0; f < vertices_.size(); ++f) {
    if (!open[f] || index(first_duplicate_[f]) != f) continue;
    const Vec3 normal = faceNormal(mesh, f);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 at = mesh.corner(f, static_cast<int>(k));
      const Vec3 a = (mesh.corner(f, static_cast<int>((k + 1) % 3)) - at).normalized();
      const Vec3 b = (mesh.corner(f, static_cast<int>((k + 2) % 3)) - at).normalized();
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      Corner& corner = corners_[index(vertices_[f][k])];
      corner.normal += angle * normal;
      corner.outward -= angle * (a + b).normalized();
    }
  }
  std::vector<std::array<std::uint8_t, 3>> seam(seams.empty() ? 0 : vertices_.size());
  for (const FaceEdge& edge : seams)
    seam[index(edge.face)][static_cast<std::size_t>(edge.edge)] = 1;
  forEachEdge(
      vertices_, [&](std::size_t f) { return open[f] != 0 && index(first_duplicate_[f]) == f; },
      [&](const EdgeUse* first, const EdgeUse* last) {
        Edge edge;
        edge.rim =
            last - first == 1 &&
            (seam.empty() || !seam[index(first->face)][static_cast<std::size_t>(first->edge)]);
        for (auto use = first; use != last; ++use) {
          edge.normal += faceNormal(mesh, index(use->face));
          edge_of_[index(use->face)][static_cast<std::size_t>(use->edge)] =
              static_cast<std::int32_t>(edges_.size());
        }
        if (edge.rim)
          for (const std::int32_t v : {first->low, first->high}) corners_[index(v)].rim = true;
        edges_.push_back(edge);
      });
}

Side PseudonormalSide::at(const Vec3& p, std::int32_t face) const {
  constexpr double kOver = 1e-6; // fraction of the distance
  constexpr double kSlit = 0.1;  // sin(a)/a of half the angle about a corner, here 150 degrees
  const std::size_t f = index(first_duplicate_[index(face)]);
  const Vec3 a = mesh_.corner(f, 0), b = mesh_.corner(f, 1), c = mesh_.corner(f, 2);
  const Vec3 w = closestBarycentric(p, a, b, c);
  const Vec3 from = p - (w[0] * a + w[1] * b + w[2] * c);
  Vec3 normal = faceNormal(mesh_, f);
  bool beyond = false;
  const auto zeros = (w.array() == 0).count();
  if (zeros == 1) {
    const std::size_t k = w[0] == 0 ? 1 : w[1] == 0 ? 2 : 0; // from corner k to the next
    const Edge& edge = edges_[index(edge_of_[f][k])];
    const Vec3 along =
        mesh_.corner(f, static_cast<int>((k + 1) % 3)) - mesh_.corner(f, static_cast<int>(k));
    beyond = edge.rim && from.dot(along.cross(normal).normalized()) > kOver * from.norm();
    normal = edge.normal;
  } else if (zeros == 2) {
    const std::size_t k = w[0] != 0 ? 0 : w[1] != 0 ? 1 : 2;
    const Corner& corner = corners_[index(vertices_[f][k])];
    // Projects the outward direction onto the surface's plane.
    const Vec3 n = corner.normal.normalized();
    const Vec3 outward = corner.outward - corner.outward.dot(n) * n;
    // A vertex with surface almost all round, as at the end of a slit, has no outside.
    beyond = corner.rim && outward.norm() > kSlit * corner.normal.norm() &&
             from.dot(outward.normalized()) > kOver * from.norm();
    normal = corner.normal;
  }
  if (beyond) return Side::beyond_boundary;
  return from.dot(normal) < 0 ? Side::back : Side::front;
}

} // namespace patina
