#include "geometry/mesh/mesh_report.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "geometry/mesh/border_weld.h"
#include "geometry/mesh/disjoint_sets.h"

namespace patina {
namespace {

// A triangle is closed_up if the weld made two of its corners one.
enum class Fault : std::uint8_t { none, non_finite, degenerate, duplicate, closed_up };

Fault faultOf(const TriangleMesh& mesh, std::size_t t) {
  const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
  if (!a.allFinite() || !b.allFinite() || !c.allFinite()) return Fault::non_finite;
  const Triangle& v = mesh.triangles[t];
  if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return Fault::degenerate;
  // In units of the largest extent, so that neither tiny nor huge squares leave the range of a
  // double. The limit is far above the rounding of collinear points, far below any real sliver.
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

// Items filed under a vertex, as one array with offsets: sorting each short run replaces a hash
// table of all edges.
template <typename Item> class ByVertex {
 public:
  ByVertex(std::size_t vertices, std::size_t items) : ends_(vertices + 1, 0) {
    items_.reserve(items);
  }
  void count(std::int32_t vertex) { ++ends_[static_cast<std::size_t>(vertex) + 1]; }
  void startFilling() {
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    items_.resize(ends_.back());
    next_.assign(ends_.begin(), ends_.end() - 1);
  }
  void file(std::int32_t vertex, const Item& item) {
    items_[next_[static_cast<std::size_t>(vertex)]++] = item;
  }
  template <typename Visit> void forEachSortedRun(Visit visit) {
    next_ = {};
    for (std::size_t v = 0; v + 1 < ends_.size(); ++v) {
      if (ends_[v] == ends_[v + 1]) continue;
      Item* first = items_.data() + ends_[v];
      Item* last = items_.data() + ends_[v + 1];
      std::sort(first, last);
      visit(static_cast<std::int32_t>(v), first, last);
    }
  }

 private:
  std::vector<std::size_t> ends_;
  std::vector<std::size_t> next_;
  std::vector<Item> items_;
};

struct SameVertices {
  std::int32_t middle, high, triangle;
  auto operator<=>(const SameVertices&) const = default;
};

void markDuplicates(std::size_t vertices, const std::vector<Triangle>& triangles,
                    std::vector<Fault>& faults) {
  ByVertex<SameVertices> by_lowest(vertices, triangles.size());
  const auto forEach = [&](auto visit) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (faults[t] != Fault::none) continue;
      Triangle v = triangles[t];
      std::sort(v.begin(), v.end());
      visit(v, static_cast<std::int32_t>(t));
    }
  };
  forEach([&](const Triangle& v, std::int32_t) { by_lowest.count(v[0]); });
  by_lowest.startFilling();
  forEach([&](const Triangle& v, std::int32_t t) { by_lowest.file(v[0], {v[1], v[2], t}); });
  by_lowest.forEachSortedRun(
      [&](std::int32_t, const SameVertices* first, const SameVertices* last) {
        for (const SameVertices* item = first + 1; item < last; ++item)
          if (item[-1].middle == item->middle && item[-1].high == item->high)
            faults[static_cast<std::size_t>(item->triangle)] = Fault::duplicate;
      });
}

struct DirectedUse {
  std::int32_t high;
  bool upwards; // the face runs from the lower vertex to the higher
  auto operator<=>(const DirectedUse&) const = default;
};

// Adds to the report's counts; `border` receives the edges of one face.
template <class ForEachEdge>
void countEdges(std::size_t vertices, std::size_t edges, const ForEachEdge& forEachEdge,
                MeshReport& report, std::vector<BoundaryEdge>& border) {
  ByVertex<DirectedUse> by_lower(vertices, edges);
  const auto forEach = [&](auto visit) {
    forEachEdge([&](std::int32_t from, std::int32_t to) {
      visit(std::min(from, to), DirectedUse{std::max(from, to), from < to});
    });
  };
  forEach([&](std::int32_t low, const DirectedUse&) { by_lower.count(low); });
  by_lower.startFilling();
  forEach([&](std::int32_t low, const DirectedUse& use) { by_lower.file(low, use); });
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

// Counts duplicates, components and edges; the triangles may name other vertices than the mesh's.
// Returns the edges of one face.
std::vector<BoundaryEdge> countTopology(std::size_t vertices,
                                        const std::vector<Triangle>& triangles,
                                        std::vector<Fault>& faults, MeshReport& report) {
  markDuplicates(vertices, triangles, faults);
  report.components = countComponents(vertices, triangles, faults);
  report.non_manifold_edges = report.misoriented_edges = 0;
  std::vector<BoundaryEdge> border;
  countEdges(
      vertices, 3 * triangles.size(),
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

// Closes cracks at the border and counts again: corners in one place, then corners within the
// tolerance, then corners on an edge. The mesh itself does not change.
void closeCracks(const TriangleMesh& mesh, std::vector<BoundaryEdge>& border,
                 std::vector<Fault>& faults, MeshReport& report) {
  Box3 box;
  for (std::size_t t = 0; t < faults.size(); ++t)
    for (int k = 0; k < 3 && faults[t] != Fault::non_finite; ++k) box.extend(mesh.corner(t, k));
  const double tolerance = kWeldTolerance * box.sizes().maxCoeff();
  if (!std::isfinite(tolerance)) return;
  std::vector<Triangle> triangles;
  const auto weld = [&](const BorderWeld& found) {
    report.widest_crack = std::max(report.widest_crack, found.widest_crack);
    if (found.vertex_of.empty()) return;
    if (triangles.empty()) triangles = mesh.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      Triangle& v = triangles[t];
      for (std::int32_t& corner : v) corner = found.vertex_of[index(corner)];
      const bool repeats = v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
      if (repeats && faults[t] == Fault::none) faults[t] = Fault::closed_up;
    }
    border = countTopology(mesh.positions.size(), triangles, faults, report);
  };
  weld(weldBorder(mesh.positions, border));
  if (!border.empty()) weld(weldBorder(mesh.positions, border, tolerance));
  if (border.empty()) return;
  const SplitBorder split = splitBorder(mesh.positions, border, tolerance);
  if (split.edges.size() == border.size()) return;
  report.widest_crack = std::max(report.widest_crack, split.widest_crack);
  countEdges(
      mesh.positions.size(), split.edges.size(),
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
  std::vector<BoundaryEdge> border =
      countTopology(mesh.positions.size(), mesh.triangles, faults, report);
  if (!border.empty()) closeCracks(mesh, border, faults, report);
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

// Keeps the vertices that triangles use, in their order.
void removeUnusedVertices(TriangleMesh& mesh) {
  std::vector<std::int32_t> index_of(mesh.positions.size(), -1);
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t) index_of[static_cast<std::size_t>(v)] = 0;
  std::int32_t used = 0;
  for (std::size_t v = 0; v < index_of.size(); ++v) {
    if (index_of[v] < 0) continue;
    mesh.positions[static_cast<std::size_t>(used)] = mesh.positions[v];
    index_of[v] = used++;
  }
  mesh.positions.resize(static_cast<std::size_t>(used));
  for (Triangle& t : mesh.triangles)
    for (std::int32_t& v : t) v = index_of[static_cast<std::size_t>(v)];
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
