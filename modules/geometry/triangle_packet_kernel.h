// The body of the packet kernel, compiled once for every instruction set: a source defines
// PATINA_KERNEL (a name of its own) and includes this. It must use no inline function of another
// header, else the linker could keep the wrong instruction set's copy for the whole program.
#pragma once

#include "geometry/packet_lanes.h"
#include "geometry/triangle_packet.h"

namespace patina::PATINA_KERNEL {

// Distances that differ by less are ties, which the lower face wins: relative, and in units of the
// tree. Above what float loses here, far below what matters.
constexpr float kTie = 2e-6f, kTieFloor = 1e-7f;
constexpr float kPadding = 2.5e-7f; // of boxes, against float's rounding of coordinates
constexpr int kStack = 640;         // 7 more a level; the tree's depth is bounded by its builder

struct Points {
  Lanes x, y, z;
};

struct Answer {
  Lanes best, limit, face_d2;
  IntLanes face, triangle;
  float max_limit;
};

// The numbers of one triangle in every lane, or of eight triangles.
struct OneTriangle {
  const PacketTriangle& t;
  PATINA_MEMBER Lanes a(int i) const { return spread(t.a[i]); }
  PATINA_MEMBER Lanes axis(int i, int j) const { return spread(t.axis[i][j]); }
  PATINA_MEMBER Lanes ab() const { return spread(t.ab); }
  PATINA_MEMBER Lanes bcX() const { return spread(t.bc_x); }
  PATINA_MEMBER Lanes bcY() const { return spread(t.bc_y); }
  PATINA_MEMBER Lanes bcAlong() const { return spread(t.bc_along); }
  PATINA_MEMBER Lanes bcAcross() const { return spread(t.bc_across); }
  PATINA_MEMBER Lanes bc() const { return spread(t.bc); }
  PATINA_MEMBER Lanes acX() const { return spread(t.ac_x); }
  PATINA_MEMBER Lanes acY() const { return spread(t.ac_y); }
  PATINA_MEMBER Lanes ac() const { return spread(t.ac); }
};

struct EightTriangles {
  Lanes row[24];
  PATINA_MEMBER Lanes a(int i) const { return row[i]; }
  PATINA_MEMBER Lanes axis(int i, int j) const { return row[3 + 3 * i + j]; }
  PATINA_MEMBER Lanes ab() const { return row[12]; }
  PATINA_MEMBER Lanes bcX() const { return row[13]; }
  PATINA_MEMBER Lanes bcY() const { return row[14]; }
  PATINA_MEMBER Lanes bcAlong() const { return row[15]; }
  PATINA_MEMBER Lanes bcAcross() const { return row[16]; }
  PATINA_MEMBER Lanes bc() const { return row[17]; }
  PATINA_MEMBER Lanes acX() const { return row[18]; }
  PATINA_MEMBER Lanes acY() const { return row[19]; }
  PATINA_MEMBER Lanes ac() const { return row[20]; }
};

PATINA_INLINE void gather(const PacketTriangle* triangles, const std::int32_t (&index)[kWide],
                          EightTriangles& t) {
  const float* rows[3][kWide];
  for (int i = 0; i < kWide; ++i) {
    rows[0][i] = triangles[index[i]].a;
    rows[1][i] = rows[0][i] + 8;
    rows[2][i] = rows[0][i] + 16;
  }
  transpose(rows[0], t.row);
  transpose(rows[1], t.row + 8);
  transpose(rows[2], t.row + 16);
}

// Squared distance, given the points relative to the triangle's corner A.
template <typename T>
PATINA_INLINE Lanes squaredDistance(const T& t, const Lanes& rx, const Lanes& ry, const Lanes& rz) {
  const Lanes x = madd(rx, t.axis(0, 0), madd(ry, t.axis(0, 1), rz * t.axis(0, 2)));
  const Lanes y = madd(rx, t.axis(1, 0), madd(ry, t.axis(1, 1), rz * t.axis(1, 2)));
  const Lanes z = madd(rx, t.axis(2, 0), madd(ry, t.axis(2, 1), rz * t.axis(2, 2)));
  const Lanes zero = spread(0.0f);
  const Lanes along1 = madd(x, t.bcX(), madd(y, t.bcY(), t.bcAlong()));
  const Lanes across1 = madd(y, t.bcX(), t.bcAcross() - x * t.bcY());
  const Lanes along2 = madd(x, t.acX(), y * t.acY());
  const Lanes across2 = x * t.acY() - y * t.acX();
  const Lanes over0 = x - smaller(larger(x, zero), t.ab());
  const Lanes over1 = along1 - smaller(larger(along1, zero), t.bc());
  const Lanes over2 = along2 - smaller(larger(along2, zero), t.ac());
  const Lanes edge0 = madd(over0, over0, y * y);
  const Lanes edge1 = madd(over1, over1, across1 * across1);
  const Lanes edge2 = madd(over2, over2, across2 * across2);
  // Strictly inside: a triangle without area has no inside.
  const Mask inside = smaller(y, smaller(across1, across2)) > zero;
  const Lanes edge = smaller(edge0, smaller(edge1, edge2));
  return madd(z, z, choose(inside, zero, edge));
}

// Squared distances up to this are ties with `best`.
PATINA_INLINE Lanes tieLimit(const Lanes& best) {
  const Lanes limit = madd(root(best), spread(1 + kTie), spread(kTieFloor));
  return limit * limit;
}

PATINA_INLINE void tryTriangle(const PacketTriangle* triangles, std::int32_t index, const Points& p,
                               Answer& answer) {
  const PacketTriangle& t = triangles[index];
  const Lanes d2 = squaredDistance(OneTriangle{t}, p.x - spread(t.a[0]), p.y - spread(t.a[1]),
                                   p.z - spread(t.a[2]));
  if (!any(d2 <= answer.limit)) return;
  answer.best = smaller(answer.best, d2);
  answer.limit = tieLimit(answer.best);
  const Mask take =
      (d2 <= answer.limit) & ((spread(t.face) < answer.face) | (answer.limit < answer.face_d2));
  answer.face = choose(take, spread(t.face), answer.face);
  answer.triangle = choose(take, spread(index), answer.triangle);
  answer.face_d2 = choose(take, d2, answer.face_d2);
  answer.max_limit = largest(answer.limit);
}

// An axis-aligned box, every coordinate in all lanes.
struct Box {
  Lanes centre[3], half[3];
};

PATINA_INLINE Box boxOf(const float (&lo)[3], const float (&hi)[3]) {
  Box box;
  for (int a = 0; a < 3; ++a) {
    box.centre[a] = spread(0.5f * (lo[a] + hi[a]));
    box.half[a] = spread(0.5f * (hi[a] - lo[a]) + kPadding);
  }
  return box;
}

PATINA_INLINE Lanes gap(const Lanes& offset, const Lanes& half) {
  return larger(magnitude(offset) - half, spread(0.0f));
}

PATINA_INLINE Lanes lengthSquared(const Lanes& x, const Lanes& y, const Lanes& z) {
  return madd(x, x, madd(y, y, z * z));
}

// Squared distances of eight boxes from one.
template <typename Rows>
PATINA_INLINE Lanes boxDistances(const Rows& centre, const Rows& half, const Box& box) {
  return lengthSquared(gap(load(centre[0]) - box.centre[0], load(half[0]) + box.half[0]),
                       gap(load(centre[1]) - box.centre[1], load(half[1]) + box.half[1]),
                       gap(load(centre[2]) - box.centre[2], load(half[2]) + box.half[2]));
}

// Lower bounds of squared distances of points at (x, y, z) from the centres.
PATINA_INLINE Lanes cylinderDistance(const Lanes& x, const Lanes& y, const Lanes& z,
                                     const Lanes& nx, const Lanes& ny, const Lanes& nz,
                                     const Lanes& low, const Lanes& high, const Lanes& radius) {
  const Lanes zero = spread(0.0f);
  const Lanes along = madd(x, nx, madd(y, ny, z * nz));
  const Lanes across = root(larger(lengthSquared(x, y, z) - along * along, zero));
  const Lanes over = larger(larger(along - high, low - along), zero);
  const Lanes out = larger(across - radius, zero);
  return spread(1 - 1e-5f) * madd(over, over, out * out);
}

// Of eight points from one child.
PATINA_INLINE Lanes childDistance(const WideNode& node, int place, const Points& p) {
  const Lanes x = p.x - spread(node.centre[0][place]);
  const Lanes y = p.y - spread(node.centre[1][place]);
  const Lanes z = p.z - spread(node.centre[2][place]);
  const Lanes box =
      lengthSquared(gap(x, spread(node.half[0][place])), gap(y, spread(node.half[1][place])),
                    gap(z, spread(node.half[2][place])));
  return larger(box, cylinderDistance(x, y, z, spread(node.normal[0][place]),
                                      spread(node.normal[1][place]), spread(node.normal[2][place]),
                                      spread(node.low[place]), spread(node.high[place]),
                                      spread(node.radius[place])));
}

// Of one point, in every lane, from eight children (of a node, or listed).
template <typename Rows>
PATINA_INLINE Lanes childDistances(const Rows& c, int first, const Points& p) {
  const Lanes x = p.x - load(c.centre[0] + first);
  const Lanes y = p.y - load(c.centre[1] + first);
  const Lanes z = p.z - load(c.centre[2] + first);
  const Lanes box = lengthSquared(gap(x, load(c.half[0] + first)), gap(y, load(c.half[1] + first)),
                                  gap(z, load(c.half[2] + first)));
  return larger(box, cylinderDistance(x, y, z, load(c.normal[0] + first), load(c.normal[1] + first),
                                      load(c.normal[2] + first), load(c.low + first),
                                      load(c.high + first), load(c.radius + first)));
}

struct Entry {
  float d2;
  std::int32_t node, place;
};

// The triangles below `at` that any point may need. Children near the packet's box, nearest last,
// go on the stack; each is tested against every point when its turn comes, by when the limits are
// tighter.
inline void search(const LatticeJob& job, const Points& p, const Box& box, std::int32_t at,
                   Answer& answer) {
  Entry stack[kStack];
  int top = 0;
  for (;;) {
    const WideNode& node = job.nodes[at];
    const Lanes d2 = boxDistances(node.centre, node.half, box);
    unsigned near = bits(d2 <= spread(answer.max_limit));
    alignas(32) float distance[kWide];
    store(distance, d2);
    const int base = top;
    while (near) {
      const int place = __builtin_ctz(near);
      near &= near - 1;
      int slot = top++;
      while (slot > base && stack[slot - 1].d2 < distance[place]) {
        stack[slot] = stack[slot - 1];
        --slot;
      }
      stack[slot] = {distance[place], at, place};
    }
    for (;;) {
      if (top == 0) return;
      const Entry entry = stack[--top];
      if (entry.d2 > answer.max_limit) continue;
      const WideNode& parent = job.nodes[entry.node];
      const std::int32_t child = parent.child[entry.place];
      if (child < 0) {
        tryTriangle(job.triangles, ~child, p, answer);
        continue;
      }
      if (!any(childDistance(parent, entry.place, p) <= answer.limit)) continue;
      at = child;
      break;
    }
  }
}

// The same where the limits are tight already: then order gains nothing, and costs.
inline void searchWarm(const LatticeJob& job, const Points& p, const Box& box, std::int32_t at,
                       Answer& answer) {
  std::int32_t stack[kStack];
  int top = 0;
  stack[top++] = at;
  while (top > 0) {
    const WideNode& node = job.nodes[stack[--top]];
    unsigned near = bits(boxDistances(node.centre, node.half, box) <= spread(answer.max_limit));
    while (near) {
      const int place = __builtin_ctz(near);
      near &= near - 1;
      const std::int32_t child = node.child[place];
      if (child < 0)
        tryTriangle(job.triangles, ~child, p, answer);
      else if (any(childDistance(node, place, p) <= answer.limit))
        stack[top++] = child;
    }
  }
}

// ---- One point, eight triangles: better than packets where triangles are smaller than the
// lattice's cells, so that eight nodes have little in common ----

// Where triangles are this much smaller than a cell, points are searched one by one.
constexpr float kFine = 0.4f;

struct Nearest {
  float best, limit, face_d2;
  std::int32_t face, triangle;
};

PATINA_INLINE void tryTriangles(const PacketTriangle* triangles, std::int32_t (&index)[kWide],
                                int count, const Points& p, Nearest& nearest) {
  Lanes d2;
  if (count == 1) {
    const PacketTriangle& t = triangles[index[0]];
    d2 = squaredDistance(OneTriangle{t}, p.x - spread(t.a[0]), p.y - spread(t.a[1]),
                         p.z - spread(t.a[2]));
  } else {
    for (int i = count; i < kWide; ++i) index[i] = index[0];
    EightTriangles t;
    gather(triangles, index, t);
    d2 = squaredDistance(t, p.x - t.a(0), p.y - t.a(1), p.z - t.a(2));
  }
  unsigned near = bits(d2 <= spread(nearest.limit)) & ((1u << count) - 1);
  if (!near) return;
  alignas(32) float distance[kWide];
  store(distance, d2);
  while (near) {
    const int i = __builtin_ctz(near);
    near &= near - 1;
    if (distance[i] > nearest.limit) continue;
    if (distance[i] < nearest.best) {
      nearest.best = distance[i];
      const float limit = __builtin_sqrtf(nearest.best) * (1 + kTie) + kTieFloor;
      nearest.limit = limit * limit;
    }
    const std::int32_t face = triangles[index[i]].face;
    if (face < nearest.face || nearest.limit < nearest.face_d2) {
      nearest.face = face;
      nearest.face_d2 = distance[i];
      nearest.triangle = index[i];
    }
  }
}

struct PointEntry {
  float d2;
  std::int32_t node;
};

inline void searchPoint(const LatticeJob& job, const Points& p, std::int32_t at, Nearest& nearest) {
  PointEntry stack[kStack];
  int top = 0;
  for (;;) {
    const WideNode& node = job.nodes[at];
    const Lanes d2 = childDistances(node, 0, p);
    unsigned near = bits(d2 <= spread(nearest.limit));
    alignas(32) float distance[kWide];
    store(distance, d2);
    std::int32_t triangle[kWide];
    int triangles = 0;
    const int base = top;
    while (near) {
      const int place = __builtin_ctz(near);
      near &= near - 1;
      const std::int32_t child = node.child[place];
      if (child < 0) {
        triangle[triangles++] = ~child;
        continue;
      }
      int slot = top++;
      while (slot > base && stack[slot - 1].d2 < distance[place]) {
        stack[slot] = stack[slot - 1];
        --slot;
      }
      stack[slot] = {distance[place], child};
    }
    if (triangles > 0) tryTriangles(job.triangles, triangle, triangles, p, nearest);
    do {
      if (top == 0) return;
      --top;
    } while (stack[top].d2 > nearest.limit);
    at = stack[top].node;
  }
}

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

PATINA_INLINE bool isFine(const LatticeJob& job, std::int32_t triangle) {
  const float size = job.triangles[triangle].ab;
  return size < kFine * static_cast<float>(job.spacing);
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
  alignas(32) float centre[3][kItems], half[3][kItems], normal[3][kItems];
  alignas(32) float low[kItems], high[kItems], radius[kItems];
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
      chosen.normal[a][n] = node.normal[a][items[i].place];
    }
    chosen.low[n] = node.low[items[i].place];
    chosen.high[n] = node.high[items[i].place];
    chosen.radius[n] = node.radius[items[i].place];
    chosen.node[n] = items[i].node;
    chosen.place[n] = items[i].place;
    ++n;
  }
  chosen.count = n;
  for (; n % kWide; ++n) { // places of no child
    for (int a = 0; a < 3; ++a) {
      chosen.centre[a][n] = chosen.normal[a][n] = 0;
      chosen.half[a][n] = -__builtin_inff();
    }
    chosen.low[n] = chosen.high[n] = chosen.radius[n] = 0;
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

PATINA_INLINE void searchItems(const LatticeJob& job, const Points& p, const Items& items,
                               Nearest& nearest) {
  for (int first = 0; first < items.count; first += kWide) {
    unsigned near = bits(childDistances(items, first, p) <= spread(nearest.limit));
    while (near) {
      const int at = first + __builtin_ctz(near);
      near &= near - 1;
      const std::int32_t child = job.nodes[items.node[at]].child[items.place[at]];
      if (child < 0) {
        std::int32_t index[kWide] = {~child};
        tryTriangles(job.triangles, index, 1, p, nearest);
      } else {
        searchPoint(job, p, child, nearest);
      }
    }
  }
}

// The packet's points one after the other, each from the last one's answer; among the items, or
// from the root if there are none.
PATINA_INLINE Answer searchPoints(const LatticeJob& job, const Packet& packet, float limit,
                                  std::int32_t warm, const Items* items) {
  alignas(32) float x[kWide], y[kWide], z[kWide];
  alignas(32) std::int32_t found[kWide];
  store(x, packet.points.x);
  store(y, packet.points.y);
  store(z, packet.points.z);
  alignas(32) float best[kWide];
  for (int lane = 0; lane < kWide; ++lane) {
    const Points p{spread(x[lane]), spread(y[lane]), spread(z[lane])};
    Nearest nearest{limit, limit, __builtin_inff(), 0x7fffffff, -1};
    if (warm >= 0) {
      std::int32_t index[kWide] = {warm};
      tryTriangles(job.triangles, index, 1, p, nearest);
    }
    if (items)
      searchItems(job, p, *items, nearest);
    else
      searchPoint(job, p, 0, nearest);
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
inline void latticeFromRoot(const LatticeJob& job, bool fine) {
  const int packets = job.side / 2;
  std::int32_t warm[kWide] = {-1, -1, -1, -1, -1, -1, -1, -1};
  for (int count = 0; count < packets * packets * packets; ++count) {
    const Snake at = snake(count, packets);
    Packet packet;
    place(job, {2.0 * at.i, 2.0 * at.j, 2.0 * at.k}, 1, packet);
    Answer answer = nothingWithin(job.max_distance);
    if (fine) {
      answer = searchPoints(job, packet, answer.max_limit, warm[0], nullptr);
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
  if (job.triangle_size < 4 * kFine * job.spacing)
    nearest = searchPoints(job, centres, nearest.max_limit, -1, nullptr);
  else
    search(job, centres.points, centres.box, 0, nearest);
  alignas(32) std::int32_t found[kWide];
  store(found, nearest.triangle);
  int fine = 0;
  for (int o = 0; o < kWide; ++o) fine += found[o] < 0 ? 0 : isFine(job, found[o]) ? 1 : -1;
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
  if (count < 0) return latticeFromRoot(job, true);

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
      if (chosen.count > 0 && fine > 0) {
        answer = searchPoints(job, packet, answer.max_limit, warm[0], &chosen);
      } else if (chosen.count > 0) {
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
    latticeFromRoot(job, job.triangle_size < kFine * job.spacing);
}

} // namespace patina::PATINA_KERNEL
