#include "geometry/tree/triangle_pieces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <Eigen/Core>
#include <tbb/parallel_for.h>

namespace patina {
namespace {

constexpr int kBins = 16;
constexpr float kFar = std::numeric_limits<float>::infinity();
// Deeper pieces are halved, as adversarial input could make binned splits peel off single boxes.
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

// Smaller pieces are cut into full nodes, half as many as by the area rule, which gains nothing.
constexpr std::size_t kFullNodes = 512;

// Returns the number of triangles below one child of so small a piece.
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
  // Fills `nodes` with the subtree of `piece`, root first.
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

  // Builds each subtree in its own array and concatenates: the same tree for any thread count.
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
      for (WideNode& first_leaf_node : subtrees[i]) {
        for (std::size_t k = 0; k < kWide; ++k)
          if (first_leaf_node.child[k] > 0) first_leaf_node.child[k] += offset;
        nodes.push_back(first_leaf_node);
      }
    }
  }

  static float cost(const Piece& piece, std::size_t unit) {
    const auto size = static_cast<float>(piece.size());
    return unit > 1 ? size : piece.bounds.halfArea() * size;
  }

  static void setBox(WideNode& node, std::size_t slot, const float* lo, const float* hi) {
    for (std::size_t a = 0; a < 3; ++a) {
      const float centre = 0.5f * (lo[a] + hi[a]);
      node.centre[a][slot] = centre;
      node.half[a][slot] = std::max(hi[a] - centre, centre - lo[a]) * (1 + 1e-6f);
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

// Larger subtrees are rarely flat.
constexpr std::int32_t kMaxInCylinder = 64;

struct Range {
  std::int32_t begin = std::numeric_limits<std::int32_t>::max(), end = 0;
};

using Vec3f = Eigen::Vector3f;

Vec3f axisOf(const PacketTriangle& t, int which) {
  return Eigen::Map<const Vec3f>(t.axis[which]);
}

struct Cylinder {
  Vec3f axis;
  float low = kFar, high = -kFar, radius = 0;
  float area() const { return radius * (radius + high - low); } // surface over 2 pi
};

// Returns the cylinder about a centre along an axis that holds the triangles.
Cylinder cylinderAlong(const Vec3f& axis, const Vec3f& centre, const PacketTriangle* first,
                       const PacketTriangle* last) {
  Cylinder found{axis};
  float radius2 = 0;
  const auto add = [&](const Vec3f& r) {
    const float along = r.dot(axis);
    found.low = std::min(found.low, along);
    found.high = std::max(found.high, along);
    radius2 = std::max(radius2, (r - along * axis).squaredNorm());
  };
  for (const PacketTriangle* t = first; t != last; ++t) {
    const Vec3f a = Eigen::Map<const Vec3f>(t->a) - centre;
    const Vec3f along = axisOf(*t, 0), across = axisOf(*t, 1);
    add(a);
    add(a + t->ab * along);
    add(a + t->ac * (t->ac_x * along + t->ac_y * across));
  }
  // Margins for the rounding of the kernel's floats.
  const float thickness = std::max(std::abs(found.low), std::abs(found.high));
  found.radius = std::max(std::sqrt(radius2) * (1 + 1e-3f), 1e-3f * thickness) + 5e-7f;
  const float margin = 2e-6f * (found.radius + thickness) + 5e-7f;
  found.low -= margin;
  found.high += margin;
  return found;
}

// Sums vectors, each turned to the side of the first one.
class SumOfLines {
 public:
  void add(const Vec3f& unit, float weight) {
    if (first_.isZero()) first_ = unit;
    sum_ += unit.dot(first_) < 0 ? Vec3f(-weight * unit) : Vec3f(weight * unit);
  }
  float length() const { return sum_.norm(); }
  Vec3f direction() const { return length() > 1e-20f ? Vec3f(sum_ / length()) : first_; }

 private:
  Vec3f first_ = Vec3f::Zero(), sum_ = Vec3f::Zero();
};

// Fits a flat cylinder along the normal or, about slivers side by side, a rod along them.
void fitCylinder(WideNode& node, std::size_t slot, const Range& range,
                 const std::vector<PacketTriangle>& triangles) {
  constexpr float kCompact = 0.25f; // share of its radius squared that a patch covers twice
  const PacketTriangle* const first = triangles.data() + range.begin;
  const PacketTriangle* const last = triangles.data() + range.end;
  SumOfLines normal, edge;
  for (const PacketTriangle* t = first; t != last; ++t) {
    normal.add(axisOf(*t, 2), t->ab * t->bc * t->bc_y);
    edge.add(axisOf(*t, 0), t->ab);
  }
  const Vec3f centre(node.centre[0][slot], node.centre[1][slot], node.centre[2][slot]);
  Cylinder found = cylinderAlong(normal.direction(), centre, first, last);
  if (normal.length() < kCompact * found.radius * found.radius) {
    const Cylinder rod = cylinderAlong(edge.direction(), centre, first, last);
    if (rod.area() < 0.5f * found.area()) found = rod;
  }
  for (int a = 0; a < 3; ++a) node.normal[a][slot] = found.axis[a];
  node.low[slot] = found.low;
  node.high[slot] = found.high;
  node.radius[slot] = found.radius;
}

} // namespace

std::vector<WideNode> buildWideBvh(std::vector<BoxRef>& refs) {
  return Builder(refs).build();
}

std::int32_t partitionLeavesLast(std::vector<WideNode>& nodes) {
  const auto holdsNodes = [](const WideNode& node) {
    return std::any_of(node.child, node.child + kWide,
                       [](std::int32_t child) { return child > 0; });
  };
  std::vector<std::int32_t> new_index(nodes.size());
  const auto first_leaf_node =
      static_cast<std::int32_t>(std::count_if(nodes.begin(), nodes.end(), holdsNodes));
  std::int32_t ahead = 0, behind = first_leaf_node;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    new_index[n] = holdsNodes(nodes[n]) ? ahead++ : behind++;
  for (WideNode& node : nodes)
    for (std::int32_t& child : node.child)
      if (child > 0) child = new_index[static_cast<std::size_t>(child)];
  for (std::size_t n = 0; n < nodes.size(); ++n)
    while (new_index[n] != static_cast<std::int32_t>(n)) {
      const auto to = static_cast<std::size_t>(new_index[n]);
      std::swap(nodes[n], nodes[to]);
      std::swap(new_index[n], new_index[to]);
    }
  return first_leaf_node;
}

void fitCylinders(std::vector<WideNode>& nodes, const std::vector<PacketTriangle>& triangles) {
  // Children come after their parents, and a subtree's triangles are consecutive.
  std::vector<Range> ranges(nodes.size());
  const auto rangeOf = [&](const WideNode& node, std::size_t slot) {
    const std::int32_t child = node.child[slot];
    return child < 0 ? Range{~child, ~child + 1} : ranges[static_cast<std::size_t>(child)];
  };
  const auto present = [](const WideNode& node, std::size_t slot) {
    return node.half[0][slot] >= 0;
  };
  for (std::size_t n = nodes.size(); n-- > 0;)
    for (std::size_t slot = 0; slot < kWide; ++slot) {
      if (!present(nodes[n], slot)) continue;
      const Range range = rangeOf(nodes[n], slot);
      ranges[n].begin = std::min(ranges[n].begin, range.begin);
      ranges[n].end = std::max(ranges[n].end, range.end);
    }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, nodes.size(), 256), [&](const auto& r) {
    for (std::size_t n = r.begin(); n < r.end(); ++n)
      for (std::size_t slot = 0; slot < kWide; ++slot) {
        if (!present(nodes[n], slot)) continue;
        const Range range = rangeOf(nodes[n], slot);
        if (range.end - range.begin <= kMaxInCylinder)
          fitCylinder(nodes[n], slot, range, triangles);
      }
  });
}

namespace {

constexpr double kLongest = 0.125;             // largest piece [half extents of the mesh]
constexpr std::size_t kSpareForPieces = 20000; // pieces beyond one per face
// Exceeds the rounding of float coordinates up to 2 units.
constexpr float kPadding = 2.5e-7f;

BoxRef boxOf(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t id) {
  BoxRef ref{};
  for (int axis = 0; axis < 3; ++axis) {
    ref.lo[axis] = static_cast<float>(std::min({a[axis], b[axis], c[axis]})) - kPadding;
    ref.hi[axis] = static_cast<float>(std::max({a[axis], b[axis], c[axis]})) + kPadding;
  }
  ref.setId(static_cast<std::int32_t>(id));
  return ref;
}

double longestSquared(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
}

// Halves the longest edge until it is short or the budget is used up.
void cutUp(const std::array<Vec3, 3>& whole, std::int32_t face, std::size_t budget,
           TrianglePieces& pieces) {
  std::vector<std::array<Vec3, 3>> todo{whole};
  std::size_t made = 1;
  while (!todo.empty()) {
    const auto [a, b, c] = todo.back();
    todo.pop_back();
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    const double longest = std::max({ab, bc, ca});
    if (longest <= kLongest * kLongest || made >= budget) {
      pieces.corners.push_back({a, b, c});
      pieces.face.push_back(face);
      continue;
    }
    ++made;
    if (longest == ab) {
      const Vec3 m = 0.5 * (a + b);
      todo.push_back({a, m, c});
      todo.push_back({m, b, c});
    } else if (longest == bc) {
      const Vec3 m = 0.5 * (b + c);
      todo.push_back({b, m, a});
      todo.push_back({m, c, a});
    } else {
      const Vec3 m = 0.5 * (c + a);
      todo.push_back({c, m, b});
      todo.push_back({m, a, b});
    }
  }
}

} // namespace

namespace {

std::uint64_t hashOf(const Vec3& p) {
  std::uint64_t hash = 0x9e3779b97f4a7c15U;
  for (int k = 0; k < 3; ++k) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(p[k] + 0.0)) * 0xbf58476d1ce4e5b9U; // -0 + 0 is 0
    hash ^= hash >> 29;
  }
  return hash;
}

bool isLess(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

} // namespace

std::vector<CopiedFace> findManyCopies(const std::vector<Vec3>& positions,
                                       const std::vector<Triangle>& triangles) {
  constexpr std::uint8_t kMany = 32; // Chance alone gives a bucket some ten faces.
  const auto at = [&](std::size_t face, std::size_t corner) -> const Vec3& {
    return positions[static_cast<std::size_t>(triangles[face][corner])];
  };
  std::vector<std::uint8_t> counts(std::bit_ceil(triangles.size()));
  const auto bucketOf = [&](std::size_t face) -> std::uint8_t& {
    const std::uint64_t sum = hashOf(at(face, 0)) + hashOf(at(face, 1)) + hashOf(at(face, 2));
    return counts[(sum ^ sum >> 32) & (counts.size() - 1)];
  };
  bool any = false;
  for (std::size_t face = 0; face < triangles.size(); ++face)
    if (std::uint8_t& count = bucketOf(face); count <= kMany) any |= ++count > kMany;
  if (!any) return {};
  struct Named {
    std::array<Vec3, 3> corners;
    std::int32_t face;
  };
  std::vector<Named> many;
  for (std::size_t face = 0; face < triangles.size(); ++face) {
    if (bucketOf(face) <= kMany) continue;
    many.push_back({{at(face, 0), at(face, 1), at(face, 2)}, static_cast<std::int32_t>(face)});
    std::sort(many.back().corners.begin(), many.back().corners.end(), isBefore);
  }
  std::sort(many.begin(), many.end(), [](const Named& a, const Named& b) {
    for (std::size_t k = 0; k < 3; ++k)
      if (a.corners[k] != b.corners[k]) return isLess(a.corners[k], b.corners[k]);
    return a.face < b.face;
  });
  std::vector<CopiedFace> copies;
  for (std::size_t i = 0; i < many.size();) {
    std::size_t end = i + 1;
    while (end < many.size() && many[end].corners == many[i].corners) ++end;
    for (std::size_t k = i + 1; k < end && end - i > kMany; ++k)
      copies.push_back({many[i].face, many[k].face});
    i = end;
  }
  std::sort(copies.begin(), copies.end());
  return copies;
}

TrianglePieces piecesOf(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                        const std::vector<CopiedFace>& copies) {
  TrianglePieces pieces;
  const std::size_t count = triangles.size();
  pieces.boxes.resize(count);
  std::vector<std::uint8_t> large(count);
  const auto at = [&](std::size_t face, std::size_t corner) -> const Vec3& {
    return positions[static_cast<std::size_t>(triangles[face][corner])];
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Vec3 &a = at(i, 0), &b = at(i, 1), &c = at(i, 2);
      pieces.boxes[i] = boxOf(a, b, c, i);
      large[i] = longestSquared(a, b, c) > kLongest * kLongest;
    }
  });
  constexpr std::uint8_t kCopy = 2;
  for (const CopiedFace& copied : copies) large[static_cast<std::size_t>(copied.copy)] = kCopy;
  std::size_t spare = count + kSpareForPieces;
  for (std::size_t i = 0; i < count; ++i) {
    if (large[i] != 1) continue;
    const std::size_t before = pieces.corners.size();
    cutUp({at(i, 0), at(i, 1), at(i, 2)}, static_cast<std::int32_t>(i), spare, pieces);
    const std::size_t made = pieces.corners.size() - before;
    spare -= std::min(made, spare - 1);
    for (std::size_t k = before; k < pieces.corners.size(); ++k) {
      const auto& [a, b, c] = pieces.corners[k];
      const BoxRef box = boxOf(a, b, c, count + k);
      if (k == before)
        pieces.boxes[i] = box;
      else
        pieces.boxes.push_back(box);
    }
  }
  if (!copies.empty())
    std::erase_if(pieces.boxes, [&](const BoxRef& box) {
      return static_cast<std::size_t>(box.id()) < count &&
             large[static_cast<std::size_t>(box.id())] == kCopy;
    });
  return pieces;
}

std::vector<TriangleBlock> triangleBlocks(const std::vector<WideNode>& nodes,
                                          std::int32_t first_leaf_node,
                                          const std::vector<PacketTriangle>& triangles) {
  // Shorter edges have no direction in float.
  constexpr float kShort = 1e-12f;
  const auto inverseSquare = [](float length) {
    return length > kShort ? 1 / (length * length) : 0.0f;
  };
  PacketTriangle nowhere{};
  for (int i = 0; i < 3; ++i) {
    nowhere.a[i] = 1e19f;
    nowhere.axis[i][i] = 1;
  }
  const auto begin = static_cast<std::size_t>(first_leaf_node);
  std::vector<TriangleBlock> blocks(nodes.size() - begin);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t n) {
    const WideNode& node = nodes[begin + n];
    TriangleBlock& block = blocks[n];
    for (std::size_t k = 0; k < kWide; ++k) {
      const PacketTriangle& t =
          node.half[0][k] < 0 ? nowhere : triangles[static_cast<std::size_t>(~node.child[k])];
      for (int i = 0; i < 3; ++i) {
        block.a[i][k] = t.a[i];
        block.along[i][k] = t.axis[0][i];
        block.across[i][k] = t.axis[1][i];
      }
      block.ab[k] = t.ab;
      block.c_x[k] = t.ac * t.ac_x;
      block.c_y[k] = t.ac * t.ac_y;
      block.per_bc2[k] = inverseSquare(t.bc);
      block.per_ac2[k] = inverseSquare(t.ac);
      block.face[k] = t.face;
    }
  });
  return blocks;
}

PacketTriangle packetTriangle(const Vec3& p, const Vec3& q, const Vec3& r, std::int32_t face) {
  // AB is the longest edge, so that C projects onto it even in a needle.
  const double pq = (q - p).squaredNorm(), qr = (r - q).squaredNorm(), rp = (p - r).squaredNorm();
  const bool first = pq >= qr && pq >= rp, second = !first && qr >= rp;
  const Vec3& a = first ? p : second ? q : r;
  const Vec3& b = first ? q : second ? r : p;
  const Vec3& c = first ? r : second ? p : q;

  const double length = (b - a).norm();
  const Vec3 along = length > 0 ? Vec3((b - a) / length) : Vec3::UnitX();
  const double cx = (c - a).dot(along);
  const Vec3 up = (c - a) - cx * along;
  double cy = up.norm();
  Vec3 across;
  if (cy > 1e-14 * length) {
    across = up / cy;
  } else {
    across = along.unitOrthogonal();
    cy = 0;
  }
  const Vec3 normal = along.cross(across);
  const double bc = std::hypot(cx - length, cy), ac = std::hypot(cx, cy);
  const double bc_x = bc > 0 ? (cx - length) / bc : 1, bc_y = bc > 0 ? cy / bc : 0;
  const double ac_x = ac > 0 ? cx / ac : 1, ac_y = ac > 0 ? cy / ac : 0;

  PacketTriangle t{};
  for (int i = 0; i < 3; ++i) {
    t.origin[i] = a[i];
    t.a[i] = static_cast<float>(a[i]);
    t.axis[0][i] = static_cast<float>(along[i]);
    t.axis[1][i] = static_cast<float>(across[i]);
    t.axis[2][i] = static_cast<float>(normal[i]);
  }
  t.ab = static_cast<float>(length);
  t.bc_x = static_cast<float>(bc_x);
  t.bc_y = static_cast<float>(bc_y);
  t.bc_along = static_cast<float>(-length * bc_x);
  t.bc_across = static_cast<float>(length * bc_y);
  t.bc = static_cast<float>(bc);
  t.ac_x = static_cast<float>(ac_x);
  t.ac_y = static_cast<float>(ac_y);
  t.ac = static_cast<float>(ac);
  t.face = face;
  return t;
}

} // namespace patina
