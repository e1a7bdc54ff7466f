#include "geometry/mesh/border_weld.h"

#include <algorithm>
#include <numeric>

#include "geometry/mesh/disjoint_sets.h"
#include "geometry/mesh/point_grid.h"
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

std::vector<Vec3> pointsOf(const std::vector<Vec3>& positions,
                           const std::vector<std::int32_t>& vertices) {
  std::vector<Vec3> points;
  points.reserve(vertices.size());
  for (const std::int32_t v : vertices) points.push_back(positions[index(v)]);
  return points;
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
    // Stretch by stretch, so that the box about each is small.
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

} // namespace patina
