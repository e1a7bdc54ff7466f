// The body of the packet kernel, compiled once for every instruction set: a source defines
// PATINA_KERNEL (a name of its own) and includes this. It must use no inline function of another
// header, else the linker could keep the wrong instruction set's copy for the whole program.
#pragma once

#include "geometry/tree/packet_search.h"

namespace patina::PATINA_KERNEL {

// The answer's distances again, from differences taken in double: float rounds coordinates to a
// few 1e-5 of a voxel in large grids, differences to 1e-6.
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
  return root(squaredDistance(t, load(rx), load(ry), load(rz))) + load(missing);
}

// Eight points, at the corners of a cube.
struct Packet {
  alignas(32) double x[kWide], y[kWide], z[kWide];
  Points points;
  Box box;
};

// The cube's corner at origin + spacing * (x, y, z), its side `step` spacings.
PATINA_INLINE void place(const LatticeJob& job, const double (&corner)[3], double step,
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
  return {spread(limit),      spread(limit), spread(__builtin_inff()),
          spread(0x7fffffff), spread(-1),    limit};
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

// A path through n^3 packets on which the one before is always a neighbour.
struct Snake {
  int i, j, k;
};
PATINA_INLINE Snake snake(int count, int n) {
  const int k = count / (n * n);
  const int j = count / n % n, i = count % n;
  return {(count / n) & 1 ? n - 1 - i : i, k & 1 ? n - 1 - j : j, k};
}

// ---- 8^3 lattices: the tree is descended once, for all 64 packets ----

constexpr int kItems = 1024;
// Subtrees smaller than this many spacings are listed whole: beyond, a list of smaller pieces is
// longer to read than the subtree is to search.
constexpr float kSmall = 8.0f;

// A child of a node.
struct Item {
  std::int32_t node, place;
  unsigned octants; // that may need it
};

struct Items {
  alignas(32) float centre[3][kItems], half[3][kItems];
  std::int32_t node[kItems], place[kItems];
  int count;
};

// Everything that an octant's node may have as its nearest: for each octant what is within its
// reach (squared). -1 if there is no room.
inline int collect(const LatticeJob& job, const Box& whole, float max_reach2, const Box& octants,
                   const Lanes& reach2, Item (&items)[kItems]) {
  std::int32_t stack[kStack];
  int top = 0, count = 0;
  stack[top++] = 0;
  const auto small = static_cast<float>(kSmall * kSmall * job.spacing * job.spacing);
  while (top > 0) {
    const std::int32_t at = stack[--top];
    const WideNode& node = job.nodes[at];
    unsigned near = bits(boxDistances(node.centre, node.half, whole) <= spread(max_reach2));
    while (near) {
      const int place = __builtin_ctz(near);
      near &= near - 1;
      const float x = node.half[0][place], y = node.half[1][place], z = node.half[2][place];
      const Lanes d2 = lengthSquared(
          gap(octants.centre[0] - spread(node.centre[0][place]), octants.half[0] + spread(x)),
          gap(octants.centre[1] - spread(node.centre[1][place]), octants.half[1] + spread(y)),
          gap(octants.centre[2] - spread(node.centre[2][place]), octants.half[2] + spread(z)));
      const unsigned mask = bits(d2 <= reach2);
      if (!mask) continue;
      const std::int32_t child = node.child[place];
      if (child >= 0 && 4 * (x * x + y * y + z * z) > small) {
        stack[top++] = child;
        continue;
      }
      if (count == kItems) return -1;
      items[count++] = {at, place, mask};
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
      chosen.centre[a][n] = node.centre[a][items[i].place];
      chosen.half[a][n] = node.half[a][items[i].place];
    }
    chosen.node[n] = items[i].node;
    chosen.place[n] = items[i].place;
    ++n;
  }
  chosen.count = n;
  for (; n % kWide; ++n) { // places of no child
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
    unsigned near = bits(boxDistances(centre, half, box) <= spread(answer.max_limit));
    while (near) {
      const int at = first + __builtin_ctz(near);
      near &= near - 1;
      const WideNode& node = job.nodes[items.node[at]];
      const std::int32_t child = node.child[items.place[at]];
      if (child < 0)
        tryTriangle(job.triangles, ~child, p, answer);
      else if (any(childDistance(node, items.place[at], p) <= answer.limit))
        searchWarm(job, p, box, child, answer);
    }
  }
}

// Points so far apart, next to triangles so small, have little in common: better one by one.
PATINA_INLINE bool prefersPoints(const LatticeJob& job, double apart) {
  return static_cast<double>(job.triangle_size) < apart;
}

// The packet's points one after the other, each from the last one's answer.
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
    const Points p{spread(x[lane]), spread(y[lane]), spread(z[lane])};
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

// Every packet from the root.
inline void latticeFromRoot(const LatticeJob& job) {
  const bool points = prefersPoints(job, job.spacing);
  const int packets = job.side / 2;
  std::int32_t warm[kWide] = {-1, -1, -1, -1, -1, -1, -1, -1};
  for (int count = 0; count < packets * packets * packets; ++count) {
    const Snake at = snake(count, packets);
    Packet packet;
    place(job, {2.0 * at.i, 2.0 * at.j, 2.0 * at.k}, 1, packet);
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
  // Octants are 4^3 nodes; the distance of an octant's centre bounds all of them.
  constexpr double kRadius = 2.598077 * (1 + 1e-5); // of an octant, spacings
  Packet centres;
  place(job, {1.5, 1.5, 1.5}, 4, centres);
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
  const Lanes half = spread(edge);
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
      const Snake at = snake(step, 2);
      const int i = oi + 2 * at.i, j = oj + 2 * at.j, k = ok + 2 * at.k;
      Packet packet;
      place(job, {1.0 * i, 1.0 * j, 1.0 * k}, 1, packet);
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

// ---- One point for all its candidates ----

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
  const Points p{spread(job.point[0]), spread(job.point[1]), spread(job.point[2])};
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
    unsigned near = bits(d2 <= spread(limit));
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
  descend(job.nodes, job.inner, p, limit, visit, visitBlock);
  job.count = full ? -1 : keepWithin(job, count, limit);
}

} // namespace patina::PATINA_KERNEL
