#include "geometry/mesh/adjacency.h"

#include <algorithm>
#include <numeric>

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include "geometry/mesh/edge_uses.h"

namespace patina {
namespace {

bool repeatsVertex(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

void fillVertexFaces(const TriangleMesh& mesh, Adjacency& result) {
  std::vector<std::int32_t>& offsets = result.vertex_offsets;
  offsets.assign(mesh.positions.size() + 1, 0);
  const auto forEach = [&](auto visit) {
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      const Triangle& t = mesh.triangles[f];
      for (std::size_t k = 0; k < 3; ++k) // counts a repeated vertex once
        if (std::find(t.begin(), t.begin() + k, t[k]) == t.begin() + k)
          visit(index(t[k]), static_cast<std::int32_t>(f));
    }
  };
  forEach([&](std::size_t v, std::int32_t) { ++offsets[v + 1]; });
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  result.vertex_faces.resize(index(offsets.back()));
  std::vector<std::int32_t> next(offsets.begin(), offsets.end() - 1);
  forEach([&](std::size_t v, std::int32_t f) { result.vertex_faces[index(next[v]++)] = f; });
}

// Half-edges of the oriented manifold part of a mesh. Other faces (a third one at an edge, two with
// the same edge direction, surfaces that meet in one vertex) are left over for the edge table.
class HalfEdges {
 public:
  HalfEdges(const TriangleMesh& mesh, const Adjacency& adjacency)
      : handles_(mesh.triangles.size()) {
    omerr().disable(); // Rejected faces are expected and not reported.
    structure_.reserve(mesh.positions.size(), mesh.triangles.size() * 3 / 2, mesh.triangles.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) structure_.new_vertex();
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      const Triangle& t = mesh.triangles[f];
      if (repeatsVertex(t)) continue;
      if (!isHub(adjacency, t)) {
        const OpenMesh::VertexHandle a(t[0]), b(t[1]), c(t[2]);
        handles_[f] = structure_.add_face(a, b, c);
      }
      if (!handles_[f].is_valid())
        left_over_.push_back(static_cast<std::int32_t>(f));
      else
        face_of_.push_back(static_cast<std::int32_t>(f));
    }
  }

  std::array<std::int32_t, 3> neighbours(std::size_t f, const Triangle& t) const {
    std::array<std::int32_t, 3> result = {kNone, kNone, kNone};
    if (!handles_[f].is_valid()) return result;
    OpenMesh::HalfedgeHandle half_edge = structure_.halfedge_handle(handles_[f]);
    for (int step = 0; step < 3; ++step) {
      const std::int32_t from = structure_.from_vertex_handle(half_edge).idx();
      const std::size_t k = from == t[0] ? 0 : from == t[1] ? 1 : 2;
      const OpenMesh::FaceHandle other = structure_.opposite_face_handle(half_edge);
      if (other.is_valid()) result[k] = face_of_[index(other.idx())];
      half_edge = structure_.next_halfedge_handle(half_edge);
    }
    return result;
  }
  const std::vector<std::int32_t>& leftOver() const { return left_over_; }

 private:
  // Adding a face walks round its vertices, which is quadratic at the hub of a large fan.
  static bool isHub(const Adjacency& adjacency, const Triangle& t) {
    constexpr std::int32_t kMaxFaces = 256;
    return std::any_of(t.begin(), t.end(), [&](std::int32_t v) {
      return adjacency.vertex_offsets[index(v) + 1] - adjacency.vertex_offsets[index(v)] >
             kMaxFaces;
    });
  }

  OpenMesh::TriConnectivity structure_;
  std::vector<OpenMesh::FaceHandle> handles_; // handle of each triangle; invalid if left over
  std::vector<std::int32_t> face_of_;         // triangle of each handle
  std::vector<std::int32_t> left_over_;
};

// Finds all uses of the edges of left-over faces, which the half-edges do not contain.
void resolveLeftOver(const TriangleMesh& mesh, const std::vector<std::int32_t>& left_over,
                     Adjacency& result) {
  std::vector<bool> touched(mesh.positions.size(), false);
  for (const std::int32_t f : left_over)
    for (const std::int32_t v : mesh.triangles[index(f)]) touched[index(v)] = true;
  std::vector<bool> is_left_over(mesh.triangles.size(), false);
  for (const std::int32_t f : left_over) is_left_over[index(f)] = true;

  std::vector<EdgeUse> uses;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (repeatsVertex(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      if (touched[index(a)] && touched[index(b)])
        uses.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(f),
                        static_cast<std::int32_t>(k)});
    }
  }
  std::sort(uses.begin(), uses.end());
  for (auto first = uses.begin(); first != uses.end();) {
    auto last = first + 1;
    while (last != uses.end() && last->low == first->low && last->high == first->high) ++last;
    if (std::any_of(first, last, [&](const EdgeUse& u) { return is_left_over[index(u.face)]; })) {
      const bool manifold = last - first == 2;
      for (auto use = first; use != last; ++use)
        result.face_neighbours[index(use->face)][index(use->edge)] =
            manifold ? (use == first ? first[1] : first[0]).face : kNone;
    }
    first = last;
  }
}

} // namespace

Adjacency adjacency(const TriangleMesh& mesh) {
  Adjacency result;
  fillVertexFaces(mesh, result);
  const HalfEdges half_edges(mesh, result);
  result.face_neighbours.resize(mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    result.face_neighbours[f] = half_edges.neighbours(f, mesh.triangles[f]);
  if (!half_edges.leftOver().empty()) resolveLeftOver(mesh, half_edges.leftOver(), result);
  return result;
}

std::size_t bytes(const Adjacency& adjacency) {
  return adjacency.face_neighbours.capacity() * sizeof(adjacency.face_neighbours[0]) +
         (adjacency.vertex_offsets.capacity() + adjacency.vertex_faces.capacity()) *
             sizeof(std::int32_t);
}

} // namespace patina
