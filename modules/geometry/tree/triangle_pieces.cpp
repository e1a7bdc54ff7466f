#include "geometry/tree/triangle_pieces.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

namespace patina {
namespace {

constexpr double kLongest = 0.125;             // of the mesh's half extent (0.5 to 1)
constexpr std::size_t kSpareForPieces = 20000; // beyond one a face
// More than float loses in coordinates up to 2 units.
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

TrianglePieces piecesOf(const std::vector<Vec3>& positions,
                        const std::vector<Triangle>& triangles) {
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
  std::size_t spare = count + kSpareForPieces;
  for (std::size_t i = 0; i < count; ++i) {
    if (!large[i]) continue;
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
  return pieces;
}

std::vector<TriangleBlock> triangleBlocks(const std::vector<WideNode>& nodes, std::int32_t inner,
                                          const std::vector<PacketTriangle>& triangles) {
  // Below this length the end points are one, as far as float can tell.
  constexpr float kShort = 1e-12f;
  const auto inverseSquare = [](float length) {
    return length > kShort ? 1 / (length * length) : 0.0f;
  };
  PacketTriangle nowhere{};
  for (int i = 0; i < 3; ++i) {
    nowhere.a[i] = 1e19f;
    nowhere.axis[i][i] = 1;
  }
  const auto begin = static_cast<std::size_t>(inner);
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
  // AB is the longest edge, so that C projects onto it and a needle stays harmless.
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
