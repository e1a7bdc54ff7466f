#include "geometry/tree/wide_bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Core>
#include <tbb/parallel_for.h>

namespace patina {
namespace {

constexpr int kBins = 16;
constexpr float kFar = std::numeric_limits<float>::infinity();
// Binned splits may peel off one box at a time on adversarial input; from this depth on, halves.
constexpr int kBalancedDepth = 48;
constexpr std::size_t kParallelSize = 20000;

using Row = Eigen::Array4f;
using RowMap = Eigen::Map<const Row, Eigen::Aligned16>;

struct Bounds {
  Row lo = Row::Constant(kFar), hi = Row::Constant(-kFar);

  void add(const Row& l, const Row& h) {
    lo = lo.min(l);
    hi = hi.max(h);
  }
  float halfArea() const {
    const Row size = hi - lo;
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

Row lowOf(const BoxRef& ref) {
  return RowMap(ref.lo);
}

Row highOf(const BoxRef& ref) {
  return RowMap(ref.hi);
}

struct Piece {
  std::size_t begin = 0, end = 0;
  Bounds bounds, centroids; // centroids doubled: lo + hi
  std::size_t size() const { return end - begin; }
};

float centroid(const BoxRef& ref, std::size_t axis) {
  return ref.lo[axis] + ref.hi[axis];
}

Piece measured(const std::vector<BoxRef>& refs, std::size_t begin, std::size_t end) {
  Piece piece{begin, end, {}, {}};
  for (std::size_t i = begin; i < end; ++i) {
    const Row lo = lowOf(refs[i]), hi = highOf(refs[i]), sum = lo + hi;
    piece.bounds.add(lo, hi);
    piece.centroids.add(sum, sum);
  }
  return piece;
}

// Up to here pieces are cut in halves rounded to whole nodes, so that nodes are full: half as many
// as the area rule would leave, and the area rule gains nothing among so few.
constexpr std::size_t kFullNodes = 512;

// Triangles below one child of a piece that small.
std::size_t unitOf(std::size_t size) {
  std::size_t unit = 1;
  while (unit * kWide < size) unit *= kWide;
  return unit;
}

class Builder {
 public:
  explicit Builder(std::vector<BoxRef>& refs) : refs_(refs) {}

  std::vector<WideNode> build() {
    std::vector<WideNode> nodes;
    node(measured(refs_, 0, refs_.size()), 0, nodes);
    return nodes;
  }

 private:
  // Fills nodes with the subtree of `piece`; its root comes first.
  void node(const Piece& piece, int depth, std::vector<WideNode>& nodes) {
    const std::size_t at = nodes.size();
    nodes.emplace_back();
    for (int a = 0; a < 3; ++a) {
      std::fill_n(nodes[at].centre[a], kWide, 0.0f);
      std::fill_n(nodes[at].half[a], kWide, -kFar);
      std::fill_n(nodes[at].normal[a], kWide, 0.0f);
    }
    std::fill_n(nodes[at].low, kWide, 0.0f);
    std::fill_n(nodes[at].high, kWide, 0.0f);
    std::fill_n(nodes[at].radius, kWide, kFar);
    std::fill_n(nodes[at].child, kWide, 0);
    if (piece.size() <= kWide) {
      for (std::size_t i = 0; i < piece.size(); ++i) {
        const BoxRef& ref = refs_[piece.begin + i];
        setBox(nodes[at], i, ref.lo, ref.hi);
        nodes[at].child[i] = ~static_cast<std::int32_t>(piece.begin + i);
      }
      return;
    }
    std::array<Piece, kWide> pieces;
    std::size_t count = 1;
    pieces[0] = piece;
    const std::size_t unit = piece.size() <= kFullNodes ? unitOf(piece.size()) : 1;
    while (count < kWide) {
      std::size_t largest = count;
      for (std::size_t i = 0; i < count; ++i)
        if (pieces[i].size() > unit &&
            (largest == count || cost(pieces[i], unit) > cost(pieces[largest], unit)))
          largest = i;
      if (largest == count) break;
      const auto [left, right] = split(pieces[largest], unit, depth);
      pieces[largest] = left;
      pieces[count++] = right;
    }
    if (piece.size() >= kParallelSize) return childrenInParallel(pieces, count, at, depth, nodes);
    for (std::size_t i = 0; i < count; ++i) {
      setBox(nodes[at], i, pieces[i].bounds.lo.data(), pieces[i].bounds.hi.data());
      const auto child = pieces[i].size() == 1 ? ~static_cast<std::int32_t>(pieces[i].begin)
                                               : static_cast<std::int32_t>(nodes.size());
      nodes[at].child[i] = child;
      if (child > 0) node(pieces[i], depth + 1, nodes);
    }
  }

  // Each subtree in its own array, then one after the other: the same tree for any thread count.
  void childrenInParallel(const std::array<Piece, kWide>& pieces, std::size_t count, std::size_t at,
                          int depth, std::vector<WideNode>& nodes) {
    std::array<std::vector<WideNode>, kWide> subtrees;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      if (pieces[i].size() == 1) return;
      subtrees[i].reserve(pieces[i].size() / 6);
      node(pieces[i], depth + 1, subtrees[i]);
    });
    std::size_t total = nodes.size();
    for (const std::vector<WideNode>& subtree : subtrees) total += subtree.size();
    nodes.reserve(total);
    for (std::size_t i = 0; i < count; ++i) {
      setBox(nodes[at], i, pieces[i].bounds.lo.data(), pieces[i].bounds.hi.data());
      const auto offset = static_cast<std::int32_t>(nodes.size());
      nodes[at].child[i] =
          pieces[i].size() == 1 ? ~static_cast<std::int32_t>(pieces[i].begin) : offset;
      for (WideNode& inner : subtrees[i]) {
        for (std::size_t k = 0; k < kWide; ++k)
          if (inner.child[k] > 0) inner.child[k] += offset;
        nodes.push_back(inner);
      }
    }
  }

  static float cost(const Piece& piece, std::size_t unit) {
    const auto size = static_cast<float>(piece.size());
    return unit > 1 ? size : piece.bounds.halfArea() * size;
  }

  static void setBox(WideNode& node, std::size_t place, const float* lo, const float* hi) {
    for (std::size_t a = 0; a < 3; ++a) {
      const float centre = 0.5f * (lo[a] + hi[a]);
      node.centre[a][place] = centre;
      node.half[a][place] = std::max(hi[a] - centre, centre - lo[a]) * (1 + 1e-6f);
    }
  }

  std::pair<Piece, Piece> split(const Piece& piece, std::size_t unit, int depth) {
    std::size_t axis = 0;
    std::array<float, 3> size{};
    for (std::size_t a = 0; a < 3; ++a) {
      size[a] = piece.centroids.hi[a] - piece.centroids.lo[a];
      if (size[a] > size[axis]) axis = a;
    }
    if (unit > 1) {
      const std::size_t units = (piece.size() + unit - 1) / unit;
      return cutAt(piece, axis, piece.begin + units / 2 * unit);
    }
    const std::size_t middle = piece.begin + piece.size() / 2;
    if (depth >= kBalancedDepth || !(size[axis] > 1e-30f)) return cutAt(piece, axis, middle);
    const float origin = piece.centroids.lo[axis];
    const float scale = kBins * 0.9999f / size[axis];
    const auto bin = [&](const BoxRef& ref) {
      return std::min(static_cast<int>((centroid(ref, axis) - origin) * scale), kBins - 1);
    };
    std::array<Bounds, kBins> bins;
    std::array<std::size_t, kBins> counts{};
    for (std::size_t i = piece.begin; i < piece.end; ++i) {
      const auto b = static_cast<std::size_t>(bin(refs_[i]));
      bins[b].add(lowOf(refs_[i]), highOf(refs_[i]));
      ++counts[b];
    }
    std::array<float, kBins> right_cost{};
    Bounds sweep;
    std::size_t swept = 0;
    for (std::size_t b = kBins - 1; b > 0; --b) {
      sweep.add(bins[b].lo, bins[b].hi);
      swept += counts[b];
      right_cost[b] = swept ? sweep.halfArea() * static_cast<float>(swept) : 0;
    }
    float best = kFar;
    std::size_t cut = 0; // first bin of the right side
    sweep = {};
    swept = 0;
    for (std::size_t b = 0; b + 1 < kBins; ++b) {
      sweep.add(bins[b].lo, bins[b].hi);
      swept += counts[b];
      if (swept == 0 || swept == piece.size()) continue;
      const float total = sweep.halfArea() * static_cast<float>(swept) + right_cost[b + 1];
      if (total < best) {
        best = total;
        cut = b + 1;
      }
    }
    if (cut == 0) return cutAt(piece, axis, middle);
    const auto first = refs_.begin() + static_cast<std::ptrdiff_t>(piece.begin);
    const auto last = refs_.begin() + static_cast<std::ptrdiff_t>(piece.end);
    const auto second = std::partition(
        first, last, [&](const BoxRef& ref) { return static_cast<std::size_t>(bin(ref)) < cut; });
    return parts(piece, static_cast<std::size_t>(second - refs_.begin()));
  }

  std::pair<Piece, Piece> cutAt(const Piece& piece, std::size_t axis, std::size_t middle) {
    const auto at = [&](std::size_t i) { return refs_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(piece.begin), at(middle), at(piece.end),
                     [axis](const BoxRef& a, const BoxRef& b) {
                       const float x = centroid(a, axis), y = centroid(b, axis);
                       return x < y || (x == y && a.id() < b.id());
                     });
    return parts(piece, middle);
  }

  std::pair<Piece, Piece> parts(const Piece& piece, std::size_t middle) const {
    return {measured(refs_, piece.begin, middle), measured(refs_, middle, piece.end)};
  }

  std::vector<BoxRef>& refs_;
};

// Larger subtrees are hardly flat.
constexpr std::int32_t kMostInCylinder = 64;

struct Range {
  std::int32_t begin = std::numeric_limits<std::int32_t>::max(), end = 0;
};

using Vec3f = Eigen::Vector3f;

Vec3f axisOf(const PacketTriangle& t, int which) {
  return Eigen::Map<const Vec3f>(t.axis[which]);
}

void fitCylinder(WideNode& node, std::size_t place, const Range& range,
                 const std::vector<PacketTriangle>& triangles) {
  const auto begin = static_cast<std::size_t>(range.begin);
  const auto end = static_cast<std::size_t>(range.end);
  const Vec3f first = axisOf(triangles[begin], 2);
  Vec3f sum = Vec3f::Zero();
  for (std::size_t i = begin; i < end; ++i) {
    const PacketTriangle& t = triangles[i];
    const Vec3f normal = axisOf(t, 2);
    const float area = t.ab * t.bc * t.bc_y;
    sum += normal.dot(first) < 0 ? Vec3f(-area * normal) : Vec3f(area * normal);
  }
  const float length = sum.norm();
  const Vec3f axis = length > 1e-20f ? Vec3f(sum / length) : first;
  const Vec3f centre(node.centre[0][place], node.centre[1][place], node.centre[2][place]);
  float low = kFar, high = -kFar, radius2 = 0;
  const auto add = [&](const Vec3f& r) {
    const float along = r.dot(axis);
    low = std::min(low, along);
    high = std::max(high, along);
    radius2 = std::max(radius2, (r - along * axis).squaredNorm());
  };
  for (std::size_t i = begin; i < end; ++i) {
    const PacketTriangle& t = triangles[i];
    const Vec3f a = Eigen::Map<const Vec3f>(t.a) - centre;
    const Vec3f along = axisOf(t, 0), across = axisOf(t, 1);
    add(a);
    add(a + t.ab * along);
    add(a + t.ac * (t.ac_x * along + t.ac_y * across));
  }
  // Margins for what the kernel's float arithmetic loses; a thin rod would lose more.
  const float thickness = std::max(std::abs(low), std::abs(high));
  const float radius = std::max(std::sqrt(radius2) * (1 + 1e-3f), 0.1f * thickness) + 5e-7f;
  const float margin = 2e-6f * (radius + thickness) + 5e-7f;
  for (int a = 0; a < 3; ++a) node.normal[a][place] = axis[a];
  node.low[place] = low - margin;
  node.high[place] = high + margin;
  node.radius[place] = radius;
}

} // namespace

std::vector<WideNode> buildWideBvh(std::vector<BoxRef>& refs) {
  return Builder(refs).build();
}

std::int32_t moveLeavesBehind(std::vector<WideNode>& nodes) {
  const auto holdsNodes = [](const WideNode& node) {
    return std::any_of(node.child, node.child + kWide,
                       [](std::int32_t child) { return child > 0; });
  };
  std::vector<std::int32_t> place(nodes.size());
  const auto inner =
      static_cast<std::int32_t>(std::count_if(nodes.begin(), nodes.end(), holdsNodes));
  std::int32_t ahead = 0, behind = inner;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    place[n] = holdsNodes(nodes[n]) ? ahead++ : behind++;
  for (WideNode& node : nodes)
    for (std::int32_t& child : node.child)
      if (child > 0) child = place[static_cast<std::size_t>(child)];
  for (std::size_t n = 0; n < nodes.size(); ++n)
    while (place[n] != static_cast<std::int32_t>(n)) {
      const auto to = static_cast<std::size_t>(place[n]);
      std::swap(nodes[n], nodes[to]);
      std::swap(place[n], place[to]);
    }
  return inner;
}

void fitCylinders(std::vector<WideNode>& nodes, const std::vector<PacketTriangle>& triangles) {
  // Children come after their parents, and a subtree's triangles are consecutive.
  std::vector<Range> ranges(nodes.size());
  const auto rangeOf = [&](const WideNode& node, std::size_t place) {
    const std::int32_t child = node.child[place];
    return child < 0 ? Range{~child, ~child + 1} : ranges[static_cast<std::size_t>(child)];
  };
  const auto present = [](const WideNode& node, std::size_t place) {
    return node.half[0][place] >= 0;
  };
  for (std::size_t n = nodes.size(); n-- > 0;)
    for (std::size_t place = 0; place < kWide; ++place) {
      if (!present(nodes[n], place)) continue;
      const Range range = rangeOf(nodes[n], place);
      ranges[n].begin = std::min(ranges[n].begin, range.begin);
      ranges[n].end = std::max(ranges[n].end, range.end);
    }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, nodes.size(), 256), [&](const auto& r) {
    for (std::size_t n = r.begin(); n < r.end(); ++n)
      for (std::size_t place = 0; place < kWide; ++place) {
        if (!present(nodes[n], place)) continue;
        const Range range = rangeOf(nodes[n], place);
        if (range.end - range.begin <= kMostInCylinder)
          fitCylinder(nodes[n], place, range, triangles);
      }
  });
}

} // namespace patina
