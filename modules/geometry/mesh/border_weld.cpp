#include "geometry/mesh/border_weld.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "geometry/mesh/vertex_weld.h"

namespace patina {
namespace {

std::vector<std::int32_t> verticesOf(const std::vector<BoundaryEdge>& border) {
  std::vector<std::int32_t> vertices;
  vertices.reserve(2 * border.size());
  for (const BoundaryEdge& e : border) vertices.insert(vertices.end(), {e.from, e.to});
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// Vertices sorted by the cells of a grid, to find those near a point.
class CellGrid {
 public:
  CellGrid(const std::vector<Vec3>& positions, const std::vector<std::int32_t>& vertices,
           double cell) {
    Box3 box;
    for (const std::int32_t v : vertices) box.extend(positions[index(v)]);
    lowest_ = box.min();
    constexpr double kMaxCells = 1e9; // along an axis
    cell_ = std::max(cell, box.sizes().maxCoeff() / kMaxCells);
    for (const std::int32_t v : vertices) entries_.push_back({cellOf(positions[index(v)]), v});
    std::sort(entries_.begin(), entries_.end());
  }
  double cell() const { return cell_; }

  // Calls visit(vertex) for those in the point's cell and the ones around it. Of a crowded row of
  // cells only the first are visited, so that the time stays linear.
  template <class Visit> void forEachNear(const Vec3& point, const Visit& visit) const {
    constexpr int kMaxVisited = 64;
    const Cell cell = cellOf(point);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const Cell first = {cell[0] + dx, cell[1] + dy, cell[2] - 1};
        const Cell last = {first[0], first[1], cell[2] + 1};
        auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{first, -1});
        for (int n = 0; n < kMaxVisited && entry != entries_.end() && entry->cell <= last;
             ++n, ++entry)
          visit(entry->vertex);
      }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Entry {
    Cell cell;
    std::int32_t vertex;
    auto operator<=>(const Entry&) const = default;
  };
  Cell cellOf(const Vec3& p) const {
    const Vec3 at = (p - lowest_) / cell_;
    Cell cell{};
    for (int k = 0; k < 3; ++k)
      cell[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(at[k]));
    return cell;
  }

  Vec3 lowest_;
  double cell_ = 1;
  std::vector<Entry> entries_;
};

std::int32_t rootOf(std::vector<std::int32_t>& parent, std::int32_t v) {
  while (parent[index(v)] != v) v = parent[index(v)] = parent[index(parent[index(v)])];
  return v;
}

} // namespace

BorderWeld weldBorder(const std::vector<Vec3>& positions, const std::vector<BoundaryEdge>& border) {
  BorderWeld result;
  const std::vector<std::int32_t> vertices = verticesOf(border);
  VertexWeld places(vertices.size());
  std::vector<std::int32_t> first; // by place
  for (const std::int32_t v : vertices) {
    const std::int32_t place = places.index(positions[index(v)]);
    if (index(place) == first.size()) {
      first.push_back(v);
      continue;
    }
    if (result.vertex_of.empty()) {
      result.vertex_of.resize(positions.size());
      std::iota(result.vertex_of.begin(), result.vertex_of.end(), 0);
    }
    result.vertex_of[index(v)] = first[index(place)];
  }
  return result;
}

BorderWeld weldBorder(const std::vector<Vec3>& positions, const std::vector<BoundaryEdge>& border,
                      double tolerance) {
  constexpr double kShare = 0.25; // of an edge, so that its ends are never welded
  const std::vector<std::int32_t> vertices = verticesOf(border);
  std::unordered_map<std::int32_t, double> reach;
  for (const std::int32_t v : vertices) reach[v] = tolerance;
  double farthest = 0;
  for (const BoundaryEdge& e : border) {
    const double length = kShare * (positions[index(e.to)] - positions[index(e.from)]).norm();
    for (const std::int32_t v : {e.from, e.to}) reach[v] = std::min(reach[v], length);
  }
  for (const auto& [v, distance] : reach) farthest = std::max(farthest, distance);
  const CellGrid grid(positions, vertices, farthest);
  BorderWeld result;
  for (const std::int32_t v : vertices)
    grid.forEachNear(positions[index(v)], [&](std::int32_t other) {
      if (other >= v) return;
      const double distance = (positions[index(v)] - positions[index(other)]).norm();
      if (!(distance <= std::min(reach[v], reach[other]))) return;
      if (result.vertex_of.empty()) {
        result.vertex_of.resize(positions.size());
        std::iota(result.vertex_of.begin(), result.vertex_of.end(), 0);
      }
      const std::int32_t a = rootOf(result.vertex_of, v), b = rootOf(result.vertex_of, other);
      result.vertex_of[index(std::max(a, b))] = std::min(a, b);
      result.widest_crack = std::max(result.widest_crack, distance);
    });
  for (std::int32_t& v : result.vertex_of) v = rootOf(result.vertex_of, v);
  return result;
}

SplitBorder splitBorder(const std::vector<Vec3>& positions, const std::vector<BoundaryEdge>& border,
                        double tolerance) {
  SplitBorder result;
  double sum = 0;
  for (const BoundaryEdge& e : border)
    sum += (positions[index(e.to)] - positions[index(e.from)]).norm();
  const CellGrid grid(positions, verticesOf(border),
                      std::max(tolerance, sum / static_cast<double>(border.size())));
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
    const auto steps = static_cast<std::int64_t>(length / grid.cell()) + 1;
    for (std::int64_t i = 0; i <= steps; ++i)
      grid.forEachNear(from + way * (static_cast<double>(i) / static_cast<double>(steps)),
                       [&](std::int32_t v) {
                         const Vec3 p = positions[index(v)] - from;
                         const double along = p.dot(way) / (length * length);
                         const double off = (p - along * way).norm();
                         if (v == e.from || v == e.to || !(off <= near) ||
                             !(along * length > near && (1 - along) * length > near))
                           return;
                         on.push_back({along, v});
                         result.widest_crack = std::max(result.widest_crack, off);
                       });
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

} // namespace patina
