#include "field/surface/iso_cases.h"

#include <algorithm>
#include <cassert>

namespace patina {

const std::array<CellEdge, kCellEdges> kCellEdge{{{0, 0, 0, 0},
                                                  {0, 1, 0, 0},
                                                  {0, 0, 1, 0},
                                                  {0, 1, 1, 0},
                                                  {0, 0, 0, 1},
                                                  {1, 0, 0, 1},
                                                  {0, 0, 1, 1},
                                                  {1, 0, 1, 1},
                                                  {0, 0, 0, 2},
                                                  {1, 0, 0, 2},
                                                  {0, 1, 0, 2},
                                                  {1, 1, 0, 2}}};

namespace {

int lowCorner(const CellEdge& edge) {
  return edge.x + 2 * edge.y + 4 * edge.z;
}
int highCorner(const CellEdge& edge) {
  return lowCorner(edge) + (1 << edge.axis);
}

int edgeBetween(int a, int b) {
  for (int e = 0; e < kCellEdges; ++e) {
    const CellEdge& edge = kCellEdge[static_cast<std::size_t>(e)];
    if (lowCorner(edge) == std::min(a, b) && highCorner(edge) == std::max(a, b)) return e;
  }
  assert(false);
  return -1;
}

// Corners of the face at `side` of `axis`, counter-clockwise as seen from outside the cell.
std::array<int, 4> faceCorners(int axis, int side) {
  const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
  if (side == 1) return {base, base + u, base + u + v, base + v};
  return {base, base + v, base + u + v, base + u};
}

// next[e] = the crossed edge that follows e on the loop through e.
std::array<int, kCellEdges> segments(unsigned inside) {
  std::array<int, kCellEdges> next;
  next.fill(-1);
  const auto is_inside = [&](int corner) { return (inside >> corner & 1U) != 0; };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const std::array<int, 4> corner = faceCorners(axis, side);
      // Around the face, each run of inside corners is cut off by a segment of its own.
      for (std::size_t i = 0; i < 4; ++i) {
        if (is_inside(corner[i]) || !is_inside(corner[(i + 1) % 4])) continue;
        std::size_t last = (i + 1) % 4;
        while (is_inside(corner[(last + 1) % 4])) last = (last + 1) % 4;
        const int entering = edgeBetween(corner[i], corner[(i + 1) % 4]);
        const int leaving = edgeBetween(corner[last], corner[(last + 1) % 4]);
        next[static_cast<std::size_t>(entering)] = leaving;
      }
    }
  return next;
}

using Triangles = std::vector<std::array<int, 3>>;

// Triangles of loop[first .. last] on the base first-last, with the fewest diagonals in faces of
// the cell; returns how many those are.
int triangulate(const std::vector<int>& loop, std::size_t first, std::size_t last,
                Triangles& best) {
  best.clear();
  if (last - first < 2) return 0;
  int fewest = 1000;
  for (std::size_t apex = first + 1; apex < last; ++apex) {
    Triangles left, right;
    int bad = triangulate(loop, first, apex, left) + triangulate(loop, apex, last, right);
    if (apex - first > 1) bad += shareFace(loop[first], loop[apex]);
    if (last - apex > 1) bad += shareFace(loop[apex], loop[last]);
    if (bad >= fewest) continue;
    fewest = bad;
    best = {{loop[first], loop[apex], loop[last]}};
    best.insert(best.end(), left.begin(), left.end());
    best.insert(best.end(), right.begin(), right.end());
  }
  return fewest;
}

IsoCase makeCase(unsigned inside) {
  IsoCase result;
  for (const std::vector<int>& loop : isoLoops(inside)) {
    Triangles triangles;
    triangulate(loop, 0, loop.size() - 1, triangles);
    for (const auto& t : triangles) {
      assert(result.count < result.triangle.size());
      for (std::size_t c = 0; c < 3; ++c)
        result.triangle[result.count][c] = static_cast<std::uint8_t>(t[c]);
      ++result.count;
    }
  }
  return result;
}

} // namespace

std::vector<std::vector<int>> isoLoops(unsigned inside) {
  std::array<int, kCellEdges> next = segments(inside);
  std::vector<std::vector<int>> loops;
  for (std::size_t start = 0; start < kCellEdges; ++start) {
    if (next[start] < 0) continue;
    std::vector<int> loop;
    for (int e = static_cast<int>(start); next[static_cast<std::size_t>(e)] >= 0;) {
      loop.push_back(e);
      const int following = next[static_cast<std::size_t>(e)];
      next[static_cast<std::size_t>(e)] = -1;
      e = following;
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

bool shareFace(int edge_a, int edge_b) {
  const CellEdge& a = kCellEdge[static_cast<std::size_t>(edge_a)];
  const CellEdge& b = kCellEdge[static_cast<std::size_t>(edge_b)];
  const std::array<int, 3> at_a{a.x, a.y, a.z}, at_b{b.x, b.y, b.z};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    if (a.axis != axis && b.axis != axis && at_a[i] == at_b[i]) return true;
  }
  return false;
}

const std::array<IsoCase, 256>& isoCases() {
  static const std::array<IsoCase, 256> cases = [] {
    std::array<IsoCase, 256> made;
    for (unsigned inside = 0; inside < 256; ++inside) made[inside] = makeCase(inside);
    return made;
  }();
  return cases;
}

} // namespace patina
