#include "geometry/mesh/mesh_report.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "core/types.h"
#include "geometry/mesh/disjoint_sets.h"
#include "geometry/mesh/edge_uses.h"
#include "geometry/mesh/point_grid.h"
#include "geometry/mesh/vertex_weld.h"

namespace patina {
namespace {

// Closes the cracks of a mesh for its report: corners at nearly equal positions, and corners on an
// edge.

// Edge with one face, in the direction of that face.
struct BoundaryEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
};

struct BorderWeld {
  std::vector<std::int32_t> vertex_of; // target of each vertex; empty if none is welded
  double widest_crack = 0;             // greatest distance between two welded corners
};

struct SplitBorder {
  std::vector<BoundaryEdge> edges;
  double widest_crack = 0; // largest distance of a corner from the edge that it splits
};

std::vector<std::int32_t> verticesOf(const std::vector<BoundaryEdge>& border) {
  std::vector<std::int32_t> vertices;
  vertices.reserve(2 * border.size());
  for (const BoundaryEdge& e : border) vertices.insert(vertices.end(), {e.from, e.to});
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::vector<Vec3> pointsOf(const std::vector<Vec3>& positions,
                           const std::vector<std::int32_t>& vertices) {
  std::vector<Vec3> points;
  points.reserve(vertices.size());
  for (const std::int32_t v : vertices) points.push_back(positions[index(v)]);
  return points;
}

// Welds boundary vertices that are at most `tolerance` and a quarter of the shortest boundary edge
// at either of them apart.
BorderWeld weldBorder(const std::vector<Vec3>& positions, const std::vector<BoundaryEdge>& border,
                      double tolerance) {
  constexpr double kShare = 0.25; // fraction of an edge; its ends are never welded
  const std::vector<std::int32_t> vertices = verticesOf(border);
  std::vector<double> reach(positions.size(), tolerance);
  for (const BoundaryEdge& e : border) {
    const double length = kShare * (positions[index(e.to)] - positions[index(e.from)]).norm();
    for (const std::int32_t v : {e.from, e.to}) reach[index(v)] = std::min(reach[index(v)], length);
  }
  double farthest = 0;
  for (const std::int32_t v : vertices) farthest = std::max(farthest, reach[index(v)]);
  BorderWeld result;
  const PointGrid grid(pointsOf(positions, vertices), farthest);
  DisjointSets sets(positions.size());
  bool any = false;
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const std::int32_t v = vertices[grid.point(n)];
    grid.forEachNear(n, reach[index(v)], [&](std::size_t m) {
      const std::int32_t other = vertices[grid.point(m)];
      const double distance = (positions[index(v)] - positions[index(other)]).norm();
      if (other > v || !(distance <= reach[index(other)])) return false;
      sets.join(v, other);
      any = true;
      result.widest_crack = std::max(result.widest_crack, distance);
      return false;
    });
  }
  if (any) result.vertex_of = std::move(sets).lowest();
  return result;
}

// Splits boundary edges at boundary vertices within `tolerance` of them (T-junctions).
SplitBorder splitBorder(const std::vector<Vec3>& positions, const std::vector<BoundaryEdge>& border,
                        double tolerance) {
  SplitBorder result;
  double sum = 0;
  for (const BoundaryEdge& e : border)
    sum += (positions[index(e.to)] - positions[index(e.from)]).norm();
  const std::vector<std::int32_t> vertices = verticesOf(border);
  const double side = std::max(tolerance, sum / static_cast<double>(border.size()));
  const PointGrid grid(pointsOf(positions, vertices), side);
  struct OnEdge {
    double along;
    std::int32_t vertex;
    auto operator<=>(const OnEdge&) const = default;
  };
  std::vector<OnEdge> on;
  for (const BoundaryEdge& e : border) {
    const Vec3 from = positions[index(e.from)], way = positions[index(e.to)] - from;
    const double length = way.norm();
    const double near = std::min(tolerance, length / 4);
    on.clear();
    // Splits the edge into short sections, so that the box about each is small.
    const auto stretches = static_cast<std::int64_t>(length / side) + 1;
    for (std::int64_t i = 0; i < stretches; ++i) {
      const auto place = [&](std::int64_t k) -> Vec3 {
        return from + way * (static_cast<double>(k) / static_cast<double>(stretches));
      };
      Box3 box(place(i));
      box.extend(place(i + 1));
      box.min().array() -= near;
      box.max().array() += near;
      grid.forEachIn(box, [&](std::size_t n) {
        const std::int32_t v = vertices[grid.point(n)];
        const Vec3 p = positions[index(v)] - from;
        const double along = p.dot(way) / (length * length);
        const double off = (p - along * way).norm();
        if (v == e.from || v == e.to || !(off <= near) ||
            !(along * length > near && (1 - along) * length > near))
          return;
        on.push_back({along, v});
        result.widest_crack = std::max(result.widest_crack, off);
      });
    }
    std::sort(on.begin(), on.end());
    on.erase(std::unique(on.begin(), on.end()), on.end());
    std::int32_t last = e.from;
    for (const OnEdge& split : on) {
      result.edges.push_back({last, split.vertex});
      last = split.vertex;
    }
    result.edges.push_back({last, e.to});
  }
  return result;
}

// closed_up: the weld merged two of the triangle's corners.
enum class Fault : std::uint8_t { none, non_finite, degenerate, duplicate, closed_up };

Fault faultOf(const TriangleMesh& mesh, std::size_t t) {
  const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
  if (!a.allFinite() || !b.allFinite() || !c.allFinite()) return Fault::non_finite;
  const Triangle& v = mesh.triangles[t];
  if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return Fault::degenerate;
  // Scales by the largest extent, so that squares stay within a double's range. The limit is far
  // above the rounding of collinear points and far below any real sliver.
  constexpr double kFlat = 1e-12;
  Vec3 e1 = b - a, e2 = c - a, e3 = c - b;
  const double size = std::max(e1.cwiseAbs().maxCoeff(), e2.cwiseAbs().maxCoeff());
  if (!(size > 0) || !std::isfinite(size)) return Fault::degenerate;
  e1 /= size;
  e2 /= size;
  e3 /= size;
  const double longest = std::max({e1.squaredNorm(), e2.squaredNorm(), e3.squaredNorm()});
  return e1.cross(e2).norm() > kFlat * longest ? Fault::none : Fault::degenerate;
}

std::vector<Fault> triangleFaults(const TriangleMesh& mesh) {
  std::vector<Fault> faults(mesh.triangles.size());
  for (std::size_t t = 0; t < faults.size(); ++t) faults[t] = faultOf(mesh, t);
  return faults;
}

struct DirectedUse {
  std::int32_t high;
  bool upwards; // the face runs from the lower to the higher vertex
  auto operator<=>(const DirectedUse&) const = default;
};

// Adds to the report's counts; `border` receives the edges with one face.
template <class ForEach>
void countEdges(std::size_t vertices, const ForEach& forEachOne, MeshReport& report,
                std::vector<BoundaryEdge>& border) {
  ByVertex<DirectedUse> by_lower(vertices, [&](const auto& visit) {
    forEachOne([&](std::int32_t from, std::int32_t to) {
      visit(std::min(from, to), DirectedUse{std::max(from, to), from < to});
    });
  });
  border.clear();
  by_lower.forEachSortedRun(
      [&](std::int32_t low, const DirectedUse* first, const DirectedUse* last) {
        while (first < last) {
          const DirectedUse* next = first + 1;
          while (next < last && next->high == first->high) ++next;
          const auto uses = next - first;
          if (uses == 1)
            border.push_back(first->upwards ? BoundaryEdge{low, first->high}
                                            : BoundaryEdge{first->high, low});
          else if (uses > 2)
            ++report.non_manifold_edges;
          else if (first[0].upwards == first[1].upwards)
            ++report.misoriented_edges;
          first = next;
        }
      });
}

std::size_t countComponents(std::size_t vertices, const std::vector<Triangle>& triangles,
                            const std::vector<Fault>& faults) {
  DisjointSets sets(vertices);
  std::vector<std::uint8_t> used(vertices);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (faults[t] != Fault::none) continue;
    const Triangle& v = triangles[t];
    for (const std::int32_t vertex : v) used[index(vertex)] = 1;
    sets.join(v[0], v[1]);
    sets.join(v[0], v[2]);
  }
  std::size_t components = 0;
  for (std::size_t v = 0; v < vertices; ++v)
    components += used[v] && index(sets.find(static_cast<std::int32_t>(v))) == v;
  return components;
}

// Counts duplicates, components and edges. Returns the edges with one face.
std::vector<BoundaryEdge> countTopology(std::size_t vertices,
                                        const std::vector<Triangle>& triangles,
                                        std::vector<Fault>& faults, MeshReport& report) {
  const auto first_of =
      firstDuplicates(triangles, [&](std::size_t t) { return faults[t] == Fault::none; });
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (index(first_of[t]) != t) faults[t] = Fault::duplicate;
  report.components = countComponents(vertices, triangles, faults);
  report.non_manifold_edges = report.misoriented_edges = 0;
  std::vector<BoundaryEdge> border;
  countEdges(
      vertices,
      [&](auto visit) {
        for (std::size_t t = 0; t < triangles.size(); ++t) {
          if (faults[t] != Fault::none) continue;
          const Triangle& v = triangles[t];
          for (std::size_t k = 0; k < 3; ++k) visit(v[k], v[k == 2 ? 0 : k + 1]);
        }
      },
      report, border);
  return border;
}

// Closes cracks at the boundary and counts again: corners within the tolerance, then corners on an
// edge. The mesh itself does not change.
void closeCracks(const TriangleMesh& mesh, std::vector<Triangle>& triangles,
                 std::vector<BoundaryEdge>& border, std::vector<Fault>& faults,
                 MeshReport& report) {
  Box3 box;
  for (std::size_t t = 0; t < faults.size(); ++t)
    for (int k = 0; k < 3 && faults[t] != Fault::non_finite; ++k) box.extend(mesh.corner(t, k));
  const double tolerance = kWeldTolerance * box.sizes().maxCoeff();
  if (!std::isfinite(tolerance)) return;
  const BorderWeld found = weldBorder(mesh.positions, border, tolerance);
  report.widest_crack = found.widest_crack;
  if (!found.vertex_of.empty()) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      Triangle& v = triangles[t];
      for (std::int32_t& corner : v) corner = found.vertex_of[index(corner)];
      const bool repeats = v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
      if (repeats && faults[t] == Fault::none) faults[t] = Fault::closed_up;
    }
    border = countTopology(mesh.positions.size(), triangles, faults, report);
  }
  if (border.empty()) return;
  const SplitBorder split = splitBorder(mesh.positions, border, tolerance);
  if (split.edges.size() == border.size()) return;
  report.widest_crack = std::max(report.widest_crack, split.widest_crack);
  countEdges(
      mesh.positions.size(),
      [&](auto visit) {
        for (const BoundaryEdge& e : split.edges) visit(e.from, e.to);
      },
      report, border);
}

MeshReport inspect(const TriangleMesh& mesh, std::vector<Fault>& faults) {
  MeshReport report;
  report.triangles = mesh.triangles.size();
  report.vertices = mesh.positions.size();
  faults = triangleFaults(mesh);
  std::vector<Triangle> welded = weldedTriangles(mesh);
  std::vector<BoundaryEdge> border = countTopology(mesh.positions.size(), welded, faults, report);
  if (!border.empty()) closeCracks(mesh, welded, border, faults, report);
  report.boundary_edges = border.size();
  const auto count = [&](Fault fault) {
    return static_cast<std::size_t>(std::count(faults.begin(), faults.end(), fault));
  };
  report.non_finite = count(Fault::non_finite);
  report.degenerate = count(Fault::degenerate);
  report.duplicate = count(Fault::duplicate);
  report.watertight = report.components > 0 && report.boundary_edges == 0 &&
                      report.non_manifold_edges == 0 && report.misoriented_edges == 0;
  return report;
}

} // namespace

MeshReport inspect(const TriangleMesh& mesh) {
  std::vector<Fault> faults;
  return inspect(mesh, faults);
}

std::vector<std::int32_t> usableTriangles(const TriangleMesh& mesh) {
  std::vector<std::int32_t> usable;
  usable.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (faultOf(mesh, t) == Fault::none) usable.push_back(static_cast<std::int32_t>(t));
  return usable;
}

CleanMesh cleaned(TriangleMesh mesh) {
  std::vector<Fault> faults;
  const MeshReport report = inspect(mesh, faults);
  const std::size_t dropped = report.non_finite + report.degenerate;
  if (dropped == mesh.triangles.size())
    throw Error(dropped == 0
                    ? "the mesh has no triangles"
                    : "no triangle of the mesh is usable: " + std::to_string(report.non_finite) +
                          " not finite, " + std::to_string(report.degenerate) + " degenerate");
  if (dropped > 0) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (faults[t] == Fault::non_finite || faults[t] == Fault::degenerate) continue;
      mesh.triangles[kept] = mesh.triangles[t];
      if (!mesh.corner_uvs.empty()) mesh.corner_uvs[kept] = mesh.corner_uvs[t];
      ++kept;
    }
    mesh.triangles.resize(kept);
    if (!mesh.corner_uvs.empty()) mesh.corner_uvs.resize(kept);
  }
  removeUnusedVertices(mesh);
  return {std::move(mesh), report, dropped};
}

} // namespace patina
