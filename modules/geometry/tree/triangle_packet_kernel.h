// Body of the packet kernel, compiled once per instruction set: a source defines PATINA_KERNEL (a
// unique name) and includes this. It must use no inline function of another header, or the linker
// might keep one instruction set's copy for the whole program.
#pragma once

#include "geometry/tree/packet_triangles.h"

namespace patina::PATINA_KERNEL {

// Traversals of the tree for single points and packets.

constexpr int kDepth = 90;  // largest depth of the tree that its builder allows
constexpr int kStack = 640; // 7 more per level

struct Entry {
  float d2;
  std::int32_t node, slot;
};

// Searches the triangles below `at` that any point may need. Children near the packet's box go on
// the stack, the nearest last. Each is tested against every point when it is popped, when the
// limits are tighter.
inline void search(const LatticeJob& job, const Points& p, const Box& box, std::int32_t at,
                   Answer& answer) {
  Entry stack[kStack];
  int top = 0;
  for (;;) {
    const WideNode& node = job.nodes[at];
    const Lanes d2 = boxDistances(node.centre, node.half, box);
    unsigned near = bits(d2 <= broadcast(answer.max_limit));
    alignas(32) float distance[kWide];
    store(distance, d2);
    const int base = top;
    while (near) {
      const int slot = __builtin_ctz(near);
      near &= near - 1;
      int position = top++;
      while (position > base && stack[position - 1].d2 < distance[slot]) {
        stack[position] = stack[position - 1];
        --position;
      }
      stack[position] = {distance[slot], at, slot};
    }
    for (;;) {
      if (top == 0) return;
      const Entry entry = stack[--top];
      if (entry.d2 > answer.max_limit) continue;
      const WideNode& parent = job.nodes[entry.node];
      const std::int32_t child = parent.child[entry.slot];
      if (child < 0) {
        tryTriangle(job.triangles, ~child, p, answer);
        continue;
      }
      if (!any(childDistance(parent, entry.slot, p) <= answer.limit)) continue;
      at = child;
      break;
    }
  }
}

// Searches like search() but does not sort the children: tight limits leave few of them.
inline void searchWarm(const LatticeJob& job, const Points& p, const Box& box, std::int32_t at,
                       Answer& answer) {
  std::int32_t stack[kStack];
  int top = 0;
  stack[top++] = at;
  while (top > 0) {
    const WideNode& node = job.nodes[stack[--top]];
    unsigned near = bits(boxDistances(node.centre, node.half, box) <= broadcast(answer.max_limit));
    while (near) {
      const int slot = __builtin_ctz(near);
      near &= near - 1;
      const std::int32_t child = node.child[slot];
      if (child < 0)
        tryTriangle(job.triangles, ~child, p, answer);
      else if (any(childDistance(node, slot, p) <= answer.limit))
        stack[top++] = child;
    }
  }
}

// Stack entry: distances of a node's children that remain, infinite for those already visited.
struct StackEntry {
  alignas(32) float d2[kWide];
  std::int32_t node;
};

// Searches from the root for one point. `visit` gets a triangle, `visitBlock` those of a node from
// `first_leaf_node` on; both tighten and return the limit. The nearest child goes first, but the
// others are not sorted: few remain near enough. The limit is at most kFarthest.
template <typename Visit, typename VisitBlock>
PATINA_INLINE void descend(const WideNode* nodes, std::int32_t first_leaf_node, const Points& p,
                           float limit, const Visit& visit, const VisitBlock& visitBlock) {
  StackEntry stack[kDepth];
  int top = 0;
  std::int32_t at = 0;
  for (;;) {
    if (at >= first_leaf_node) {
      limit = visitBlock(at - first_leaf_node);
    } else {
      store(stack[top].d2, childDistances(nodes[at], p));
      stack[top++].node = at;
    }
    for (;;) {
      if (top == 0) return;
      StackEntry& entry = stack[top - 1];
      const Lanes d2 = load(entry.d2);
      const float nearest = reduceMin(d2);
      if (!(nearest <= limit)) {
        --top;
        continue;
      }
      const int slot = __builtin_ctz(bits(d2 <= broadcast(nearest)));
      entry.d2[slot] = __builtin_inff();
      at = nodes[entry.node].child[slot];
      if (at >= 0) break;
      limit = visit(~at);
    }
  }
}

inline void searchPoint(const LatticeJob& job, const Points& p, Nearest& nearest) {
  const auto visit = [&](std::int32_t triangle) __attribute__((always_inline)) {
    tryTriangle(job.triangles, triangle, p, nearest);
    return nearest.limit;
  };
  const auto visitBlock = [&](std::int32_t at) __attribute__((always_inline)) {
    const WideNode& node = job.nodes[job.first_leaf_node + at];
    take(job.triangles, squaredDistance(job.blocks[at], p), node.child, nearest);
    return nearest.limit;
  };
  descend(job.nodes, job.first_leaf_node, p, nearest.limit, visit, visitBlock);
}

// Recomputes the answer's distances from differences in double: float rounds coordinates to a few
// 1e-5 voxel in large grids, but differences to 1e-6.
PATINA_INLINE Lanes refined(const LatticeJob& job, const double (&px)[kWide],
                            const double (&py)[kWide], const double (&pz)[kWide],
                            const std::int32_t (&triangle)[kWide]) {
  std::int32_t index[kWide];
  alignas(32) float rx[kWide], ry[kWide], rz[kWide], missing[kWide];
  for (int i = 0; i < kWide; ++i) {
    index[i] = triangle[i] < 0 ? 0 : triangle[i];
    missing[i] = triangle[i] < 0 ? __builtin_inff() : 0.0f;
    const PacketTriangle& t = job.triangles[index[i]];
    rx[i] = static_cast<float>(px[i] - t.origin[0]);
    ry[i] = static_cast<float>(py[i] - t.origin[1]);
    rz[i] = static_cast<float>(pz[i] - t.origin[2]);
  }
  EightTriangles t;
  gather(job.triangles, index, t);
  return sqrt(squaredDistance(t, load(rx), load(ry), load(rz))) + load(missing);
}

// Eight points at the corners of a cube.
struct Packet {
  alignas(32) double x[kWide], y[kWide], z[kWide];
  Points points;
  Box box;
};

// Places the cube's corner at origin + spacing * (x, y, z) with a side of `step` spacings.
PATINA_INLINE void placeCube(const LatticeJob& job, const double (&corner)[3], double step,
                             Packet& packet) {
  alignas(32) float x[kWide], y[kWide], z[kWide];
  for (int lane = 0; lane < kWide; ++lane) {
    packet.x[lane] = job.origin[0] + job.spacing * (corner[0] + step * (lane & 1));
    packet.y[lane] = job.origin[1] + job.spacing * (corner[1] + step * (lane >> 1 & 1));
    packet.z[lane] = job.origin[2] + job.spacing * (corner[2] + step * (lane >> 2));
    x[lane] = static_cast<float>(packet.x[lane]);
    y[lane] = static_cast<float>(packet.y[lane]);
    z[lane] = static_cast<float>(packet.z[lane]);
  }
  packet.points = {load(x), load(y), load(z)};
  packet.box = boxOf({x[0], y[0], z[0]}, {x[7], y[7], z[7]});
}

PATINA_INLINE Answer nothingWithin(double distance) {
  const auto limit = static_cast<float>(distance * distance * (1 + 1e-5));
  return {broadcast(limit),      broadcast(limit), broadcast(__builtin_inff()),
          broadcast(0x7fffffff), broadcast(-1),    limit};
}

PATINA_INLINE void tryEach(const LatticeJob& job, const std::int32_t (&triangle)[kWide],
                           const Points& p, Answer& answer) {
  for (int lane = 0; lane < kWide; ++lane) {
    bool seen = triangle[lane] < 0;
    for (int other = 0; other < lane; ++other) seen |= triangle[other] == triangle[lane];
    if (!seen) tryTriangle(job.triangles, triangle[lane], p, answer);
  }
}

PATINA_INLINE void write(const LatticeJob& job, int i, int j, int k, const Packet& packet,
                         const Answer& answer, std::int32_t (&warm)[kWide]) {
  alignas(32) std::int32_t found[kWide];
  alignas(32) float distance[kWide];
  store(found, answer.triangle);
  store(distance, refined(job, packet.x, packet.y, packet.z, found));
  for (int lane = 0; lane < kWide; ++lane) {
    if (found[lane] >= 0) warm[lane] = found[lane];
    const int node =
        ((k + (lane >> 2)) * job.side + j + (lane >> 1 & 1)) * job.side + i + (lane & 1);
    job.triangle[node] = found[lane];
    job.distance[node] = distance[lane];
  }
}

// Serpentine order of n^3 packets, in which each is a neighbour of the one before.
struct SerpentineIndex {
  int i, j, k;
};
PATINA_INLINE SerpentineIndex serpentine(int count, int n) {
  const int k = count / (n * n);
  const int j = count / n % n, i = count % n;
  return {(count / n) & 1 ? n - 1 - i : i, k & 1 ? n - 1 - j : j, k};
}

// ---- 8^3 lattices: the tree is descended once, for all 64 packets ----

constexpr int kItems = 1024;
// Smaller subtrees [spacings] are listed whole, as a list of their parts takes longer to read.
constexpr float kSmall = 8.0f;

// A child of a node.
struct Item {
  std::int32_t node, slot;
  unsigned octants; // bit i: octant i may need it
};

struct Items {
  alignas(32) float centre[3][kItems], half[3][kItems];
  std::int32_t node[kItems], slot[kItems];
  int count;
};

// Collects all that may be nearest to a node of an octant: what is within each octant's squared
// reach. Returns -1 if there is no room.
inline int collect(const LatticeJob& job, const Box& whole, float max_reach2, const Box& octants,
                   const Lanes& reach2, Item (&items)[kItems]) {
  std::int32_t stack[kStack];
  int top = 0, count = 0;
  stack[top++] = 0;
  const auto small = static_cast<float>(kSmall * kSmall * job.spacing * job.spacing);
  while (top > 0) {
    const std::int32_t at = stack[--top];
    const WideNode& node = job.nodes[at];
    unsigned near = bits(boxDistances(node.centre, node.half, whole) <= broadcast(max_reach2));
    while (near) {
      const int slot = __builtin_ctz(near);
      near &= near - 1;
      const float x = node.half[0][slot], y = node.half[1][slot], z = node.half[2][slot];
      const Lanes d2 = lengthSquared(
          gap(octants.centre[0] - broadcast(node.centre[0][slot]), octants.half[0] + broadcast(x)),
          gap(octants.centre[1] - broadcast(node.centre[1][slot]), octants.half[1] + broadcast(y)),
          gap(octants.centre[2] - broadcast(node.centre[2][slot]), octants.half[2] + broadcast(z)));
      const unsigned mask = bits(d2 <= reach2);
      if (!mask) continue;
      const std::int32_t child = node.child[slot];
      if (child >= 0 && 4 * (x * x + y * y + z * z) > small) {
        stack[top++] = child;
        continue;
      }
      if (count == kItems) return -1;
      items[count++] = {at, slot, mask};
    }
  }
  return count;
}

PATINA_INLINE void select(const LatticeJob& job, const Item (&items)[kItems], int count, int octant,
                          Items& chosen) {
  int n = 0;
  for (int i = 0; i < count; ++i) {
    if (!(items[i].octants >> octant & 1)) continue;
    const WideNode& node = job.nodes[items[i].node];
    for (int a = 0; a < 3; ++a) {
      chosen.centre[a][n] = node.centre[a][items[i].slot];
      chosen.half[a][n] = node.half[a][items[i].slot];
    }
    chosen.node[n] = items[i].node;
    chosen.slot[n] = items[i].slot;
    ++n;
  }
  chosen.count = n;
  for (; n % kWide; ++n) { // empty slots
    for (int a = 0; a < 3; ++a) {
      chosen.centre[a][n] = 0;
      chosen.half[a][n] = -__builtin_inff();
    }
  }
}

inline void searchItems(const LatticeJob& job, const Points& p, const Box& box, const Items& items,
                        Answer& answer) {
  for (int first = 0; first < items.count; first += kWide) {
    const float* const centre[3] = {items.centre[0] + first, items.centre[1] + first,
                                    items.centre[2] + first};
    const float* const half[3] = {items.half[0] + first, items.half[1] + first,
                                  items.half[2] + first};
    unsigned near = bits(boxDistances(centre, half, box) <= broadcast(answer.max_limit));
    while (near) {
      const int at = first + __builtin_ctz(near);
      near &= near - 1;
      const WideNode& node = job.nodes[items.node[at]];
      const std::int32_t child = node.child[items.slot[at]];
      if (child < 0)
        tryTriangle(job.triangles, ~child, p, answer);
      else if (any(childDistance(node, items.slot[at], p) <= answer.limit))
        searchWarm(job, p, box, child, answer);
    }
  }
}

// Packet traversal does not pay if the points lie farther apart than a typical triangle is large.
PATINA_INLINE bool prefersPoints(const LatticeJob& job, double apart) {
  return static_cast<double>(job.triangle_size) < apart;
}

// Searches the packet's points one by one, each starting from the previous answer.
PATINA_INLINE Answer searchPoints(const LatticeJob& job, const Packet& packet, float limit,
                                  std::int32_t warm) {
  alignas(32) float x[kWide], y[kWide], z[kWide];
  alignas(32) std::int32_t found[kWide];
  store(x, packet.points.x);
  store(y, packet.points.y);
  store(z, packet.points.z);
  alignas(32) float best[kWide];
  limit = limit < kFarthest ? limit : kFarthest;
  for (int lane = 0; lane < kWide; ++lane) {
    const Points p{broadcast(x[lane]), broadcast(y[lane]), broadcast(z[lane])};
    Nearest nearest{limit, limit, __builtin_inff(), 0x7fffffff, -1};
    if (warm >= 0) tryTriangle(job.triangles, warm, p, nearest);
    searchPoint(job, p, nearest);
    found[lane] = nearest.triangle;
    best[lane] = nearest.best;
    if (nearest.triangle >= 0) warm = nearest.triangle;
  }
  Answer answer{};
  answer.best = load(best);
  answer.triangle = load(found);
  return answer;
}

// Searches every packet from the root.
inline void latticeFromRoot(const LatticeJob& job) {
  const bool points = prefersPoints(job, job.spacing);
  const int packets = job.side / 2;
  std::int32_t warm[kWide] = {-1, -1, -1, -1, -1, -1, -1, -1};
  for (int count = 0; count < packets * packets * packets; ++count) {
    const SerpentineIndex at = serpentine(count, packets);
    Packet packet;
    placeCube(job, {2.0 * at.i, 2.0 * at.j, 2.0 * at.k}, 1, packet);
    Answer answer = nothingWithin(job.max_distance);
    if (points) {
      answer = searchPoints(job, packet, answer.max_limit, warm[0]);
    } else {
      tryEach(job, warm, packet.points, answer);
      search(job, packet.points, packet.box, 0, answer);
    }
    write(job, 2 * at.i, 2 * at.j, 2 * at.k, packet, answer, warm);
  }
}

inline void lattice8(const LatticeJob& job) {
  // Octants are 4^3 nodes; the distance of an octant's centre bounds those of all its nodes.
  constexpr double kRadius = 2.598077 * (1 + 1e-5); // radius of an octant [spacings]
  Packet centres;
  placeCube(job, {1.5, 1.5, 1.5}, 4, centres);
  Answer nearest = nothingWithin(job.max_distance + kRadius * job.spacing);
  if (prefersPoints(job, 4 * job.spacing))
    nearest = searchPoints(job, centres, nearest.max_limit, -1);
  else
    search(job, centres.points, centres.box, 0, nearest);
  alignas(32) std::int32_t found[kWide];
  store(found, nearest.triangle);
  alignas(32) float reach2[kWide], centre_d2[kWide], x[kWide], y[kWide], z[kWide];
  store(centre_d2, nearest.best);
  float max_reach2 = -1;
  for (int o = 0; o < kWide; ++o) {
    const double reach = __builtin_sqrt(static_cast<double>(centre_d2[o])) * (1 + 1e-5) +
                         kRadius * job.spacing + 1e-6;
    const double r = (reach < job.max_distance ? reach : job.max_distance) * (1 + 1e-5);
    reach2[o] = found[o] < 0 ? -1.0f : static_cast<float>(r * r);
    max_reach2 = reach2[o] > max_reach2 ? reach2[o] : max_reach2;
  }
  if (max_reach2 < 0) {
    for (int i = 0; i < 512; ++i) {
      job.triangle[i] = -1;
      job.distance[i] = __builtin_inff();
    }
    return;
  }
  const auto edge = static_cast<float>(1.5 * job.spacing) + kPadding;
  const Lanes half = broadcast(edge);
  const Box octants{{centres.points.x, centres.points.y, centres.points.z}, {half, half, half}};
  store(x, centres.points.x);
  store(y, centres.points.y);
  store(z, centres.points.z);
  const Box whole =
      boxOf({x[0] - edge, y[0] - edge, z[0] - edge}, {x[7] + edge, y[7] + edge, z[7] + edge});
  Item items[kItems];
  const int count = collect(job, whole, max_reach2, octants, load(reach2), items);
  if (count < 0) return latticeFromRoot(job);

  Items chosen;
  for (int o = 0; o < kWide; ++o) {
    const int oi = 4 * (o & 1), oj = 4 * (o >> 1 & 1), ok = 4 * (o >> 2);
    std::int32_t warm[kWide] = {found[o], -1, -1, -1, -1, -1, -1, -1};
    if (reach2[o] < 0)
      chosen.count = 0;
    else
      select(job, items, count, o, chosen);
    for (int step = 0; step < kWide; ++step) {
      const SerpentineIndex at = serpentine(step, 2);
      const int i = oi + 2 * at.i, j = oj + 2 * at.j, k = ok + 2 * at.k;
      Packet packet;
      placeCube(job, {1.0 * i, 1.0 * j, 1.0 * k}, 1, packet);
      Answer answer = nothingWithin(job.max_distance);
      if (chosen.count > 0) {
        tryEach(job, warm, packet.points, answer);
        searchItems(job, packet.points, packet.box, chosen, answer);
      }
      write(job, i, j, k, packet, answer, warm);
    }
  }
}

void lattice(const LatticeJob& job) {
  if (job.side == 8)
    lattice8(job);
  else
    latticeFromRoot(job);
}

// ---- All candidates of one point ----

PATINA_INLINE int keepWithin(PointJob& job, int count, float limit) {
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    if (job.distance2[i] > limit) continue;
    job.face[kept] = job.face[i];
    job.distance2[kept++] = job.distance2[i];
  }
  return kept;
}

void pointCandidates(PointJob& job) {
  const Points p{broadcast(job.point[0]), broadcast(job.point[1]), broadcast(job.point[2])};
  const auto withSlack = [&](float distance) {
    return (distance + job.slack) * (distance + job.slack);
  };
  float limit = withSlack(job.reach);
  int count = 0;
  bool full = false;
  const auto take = [&](float d2, std::int32_t face) __attribute__((always_inline)) {
    if (count == PointJob::kMost) count = keepWithin(job, count, limit);
    if (count == PointJob::kMost) {
      full = true;
      limit = -1; // ends the descent
      return;
    }
    const float sharper = withSlack(__builtin_sqrtf(d2));
    if (sharper < limit) {
      limit = sharper;
      const std::int32_t* const corners = job.corners + 3 * face;
      for (int k = 0; k < 3; ++k) __builtin_prefetch(job.positions + 3 * corners[k]);
    }
    job.face[count] = face;
    job.distance2[count++] = d2;
  };
  const auto visit = [&](std::int32_t triangle) __attribute__((always_inline)) {
    const float d2 = first(squaredDistance(job.triangles[triangle], p));
    if (d2 <= limit) take(d2, job.triangles[triangle].face);
    return limit;
  };
  const auto visitBlock = [&](std::int32_t at) __attribute__((always_inline)) {
    const TriangleBlock& block = job.blocks[at];
    const Lanes d2 = squaredDistance(block, p);
    unsigned near = bits(d2 <= broadcast(limit));
    if (!near) return limit;
    alignas(32) float distance2[kWide];
    store(distance2, d2);
    while (near) {
      const int i = __builtin_ctz(near);
      near &= near - 1;
      if (distance2[i] <= limit) take(distance2[i], block.face[i]);
    }
    return limit;
  };
  descend(job.nodes, job.first_leaf_node, p, limit, visit, visitBlock);
  job.count = full ? -1 : keepWithin(job, count, limit);
}

} // namespace patina::PATINA_KERNEL
