// The body of the packet kernel, compiled once for every instruction set: a source defines
// PATINA_KERNEL (a name of its own) and includes this. It must use no inline function of another
// header, else the linker could keep the wrong instruction set's copy for the whole program.
#pragma once

#include "geometry/packet_lanes.h"
#include "geometry/triangle_packet.h"

namespace patina::PATINA_KERNEL {

// Distances that differ by less are ties, which the lower face wins: squared, relative and (in
// squared units of the tree) absolute. Above what float loses here, far below what matters.
constexpr float kTie = 1.0f + 4e-6f;
constexpr float kTieFloor = 1e-14f;
constexpr int kStack = 640; // 7 more a level; the tree's depth is bounded by its builder

struct Points {
  Lanes x, y, z;
};

struct Answer {
  Lanes best, limit, face_d2;
  IntLanes face, triangle;
  float max_limit;
};

// Squared distance, given the points relative to the triangle's corner A.
PATINA_INLINE Lanes squaredDistance(const PacketTriangle& t, const Lanes& rx, const Lanes& ry,
                                    const Lanes& rz) {
  const Lanes x =
      madd(rx, spread(t.axis[0][0]), madd(ry, spread(t.axis[0][1]), rz * spread(t.axis[0][2])));
  const Lanes y =
      madd(rx, spread(t.axis[1][0]), madd(ry, spread(t.axis[1][1]), rz * spread(t.axis[1][2])));
  const Lanes z =
      madd(rx, spread(t.axis[2][0]), madd(ry, spread(t.axis[2][1]), rz * spread(t.axis[2][2])));
  const Lanes zero = spread(0.0f);
  const Lanes bc_x = spread(t.bc_x), bc_y = spread(t.bc_y);
  const Lanes along1 = madd(x, bc_x, madd(y, bc_y, spread(t.bc_along)));
  const Lanes across1 = madd(y, bc_x, spread(t.bc_across) - x * bc_y);
  const Lanes ac_x = spread(t.ac_x), ac_y = spread(t.ac_y);
  const Lanes along2 = madd(x, ac_x, y * ac_y);
  const Lanes across2 = x * ac_y - y * ac_x;
  const Lanes over0 = x - smaller(larger(x, zero), spread(t.ab));
  const Lanes over1 = along1 - smaller(larger(along1, zero), spread(t.bc));
  const Lanes over2 = along2 - smaller(larger(along2, zero), spread(t.ac));
  const Lanes edge0 = madd(over0, over0, y * y);
  const Lanes edge1 = madd(over1, over1, across1 * across1);
  const Lanes edge2 = madd(over2, over2, across2 * across2);
  // Strictly inside: a triangle without area has no inside.
  const Mask inside = smaller(y, smaller(across1, across2)) > zero;
  const Lanes edge = smaller(edge0, smaller(edge1, edge2));
  return madd(z, z, choose(inside, zero, edge));
}

PATINA_INLINE void tryTriangle(const PacketTriangle* triangles, std::int32_t index, const Points& p,
                               Answer& answer) {
  const PacketTriangle& t = triangles[index];
  const Lanes d2 =
      squaredDistance(t, p.x - spread(t.a[0]), p.y - spread(t.a[1]), p.z - spread(t.a[2]));
  if (!any(d2 <= answer.limit)) return;
  answer.best = smaller(answer.best, d2);
  answer.limit = madd(answer.best, spread(kTie), spread(kTieFloor));
  const Mask take =
      (d2 <= answer.limit) & ((spread(t.face) < answer.face) | (answer.limit < answer.face_d2));
  answer.face = choose(take, spread(t.face), answer.face);
  answer.triangle = choose(take, spread(index), answer.triangle);
  answer.face_d2 = choose(take, d2, answer.face_d2);
  answer.max_limit = largest(answer.limit);
}

PATINA_INLINE Lanes gap(const Lanes& lo, const Lanes& hi, const Lanes& p_lo, const Lanes& p_hi) {
  return larger(larger(lo - p_hi, p_lo - hi), spread(0.0f));
}

PATINA_INLINE bool anyLaneNear(const WideNode& node, int place, const Points& p,
                               const Lanes& limit) {
  const Lanes gx = gap(spread(node.lo[0][place]), spread(node.hi[0][place]), p.x, p.x);
  const Lanes gy = gap(spread(node.lo[1][place]), spread(node.hi[1][place]), p.y, p.y);
  const Lanes gz = gap(spread(node.lo[2][place]), spread(node.hi[2][place]), p.z, p.z);
  return any(madd(gx, gx, madd(gy, gy, gz * gz)) <= limit);
}

struct Entry {
  float d2;
  std::int32_t node, place;
};

// Children near the packet's box, nearest last, go on the stack; each is tested against every
// point when its turn comes, by when the limits are tighter.
inline void search(const LatticeJob& job, const Points& p, const float (&box)[6], Answer& answer) {
  Entry stack[kStack];
  int top = 0;
  std::int32_t at = 0;
  const Lanes x_lo = spread(box[0]), x_hi = spread(box[1]), y_lo = spread(box[2]),
              y_hi = spread(box[3]), z_lo = spread(box[4]), z_hi = spread(box[5]);
  for (;;) {
    const WideNode& node = job.nodes[at];
    const Lanes gx = gap(load(node.lo[0]), load(node.hi[0]), x_lo, x_hi);
    const Lanes gy = gap(load(node.lo[1]), load(node.hi[1]), y_lo, y_hi);
    const Lanes gz = gap(load(node.lo[2]), load(node.hi[2]), z_lo, z_hi);
    const Lanes d2 = madd(gx, gx, madd(gy, gy, gz * gz));
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
      if (!anyLaneNear(parent, entry.place, p, answer.limit)) continue;
      const std::int32_t child = parent.child[entry.place];
      if (child < 0) {
        tryTriangle(job.triangles, ~child, p, answer);
      } else {
        at = child;
        break;
      }
    }
  }
}

// The answer's distances again, from differences taken in double: float rounds coordinates to a
// few 1e-5 of a voxel in large grids, differences to 1e-6.
PATINA_INLINE Lanes refined(const LatticeJob& job, const double (&px)[kWide],
                            const double (&py)[kWide], const double (&pz)[kWide],
                            const std::int32_t (&triangle)[kWide]) {
  alignas(32) float result[kWide];
  unsigned todo = 0;
  for (int i = 0; i < kWide; ++i) {
    result[i] = __builtin_inff();
    if (triangle[i] >= 0) todo |= 1u << i;
  }
  while (todo) {
    const std::int32_t index = triangle[__builtin_ctz(todo)];
    const PacketTriangle& t = job.triangles[index];
    alignas(32) float rx[kWide], ry[kWide], rz[kWide], d2[kWide];
    for (int i = 0; i < kWide; ++i) rx[i] = static_cast<float>(px[i] - t.origin[0]);
    for (int i = 0; i < kWide; ++i) ry[i] = static_cast<float>(py[i] - t.origin[1]);
    for (int i = 0; i < kWide; ++i) rz[i] = static_cast<float>(pz[i] - t.origin[2]);
    store(d2, squaredDistance(t, load(rx), load(ry), load(rz)));
    for (int i = 0; i < kWide; ++i) {
      const bool mine = triangle[i] == index;
      result[i] = mine ? d2[i] : result[i];
      todo &= ~(static_cast<unsigned>(mine) << i);
    }
  }
  return root(load(result));
}

void lattice(const LatticeJob& job) {
  const int packets = job.side / 2;
  const float start = static_cast<float>(job.max_distance * job.max_distance * (1 + 1e-5));
  alignas(32) std::int32_t warm[kWide];
  for (int i = 0; i < kWide; ++i) warm[i] = -1;
  for (int count = 0; count < packets * packets * packets; ++count) {
    // A snake through the packets, so that the one before is always a neighbour.
    const int k = count / (packets * packets);
    int j = count / packets % packets;
    int i = count % packets;
    if (k & 1) j = packets - 1 - j;
    if ((count / packets) & 1) i = packets - 1 - i;

    alignas(32) double px[kWide], py[kWide], pz[kWide];
    alignas(32) float fx[kWide], fy[kWide], fz[kWide];
    for (int lane = 0; lane < kWide; ++lane) {
      px[lane] = job.origin[0] + job.spacing * (2 * i + (lane & 1));
      py[lane] = job.origin[1] + job.spacing * (2 * j + (lane >> 1 & 1));
      pz[lane] = job.origin[2] + job.spacing * (2 * k + (lane >> 2));
      fx[lane] = static_cast<float>(px[lane]);
      fy[lane] = static_cast<float>(py[lane]);
      fz[lane] = static_cast<float>(pz[lane]);
    }
    const Points p{load(fx), load(fy), load(fz)};
    const float box[6] = {fx[0], fx[7], fy[0], fy[7], fz[0], fz[7]};
    Answer answer{spread(start),      spread(start), spread(__builtin_inff()),
                  spread(0x7fffffff), spread(-1),    start};
    for (int lane = 0; lane < kWide; ++lane) {
      bool seen = warm[lane] < 0;
      for (int other = 0; other < lane; ++other) seen |= warm[other] == warm[lane];
      if (!seen) tryTriangle(job.triangles, warm[lane], p, answer);
    }
    search(job, p, box, answer);

    alignas(32) std::int32_t found[kWide];
    alignas(32) float distance[kWide];
    store(found, answer.triangle);
    store(distance, refined(job, px, py, pz, found));
    for (int lane = 0; lane < kWide; ++lane) {
      if (found[lane] >= 0) warm[lane] = found[lane];
      const int node = ((2 * k + (lane >> 2)) * job.side + 2 * j + (lane >> 1 & 1)) * job.side +
                       2 * i + (lane & 1);
      job.triangle[node] = found[lane];
      job.distance[node] = distance[lane];
    }
  }
}

} // namespace patina::PATINA_KERNEL
