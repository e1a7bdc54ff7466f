// Part of the packet kernel (see triangle_packet_kernel.h): distances from triangles, and the
// running answers.
#pragma once

#include "geometry/tree/packet_bounds.h"

namespace patina::PATINA_KERNEL {

// Distances that differ by less are ties, which the lower face wins: relative, and in units of the
// tree. Above what float loses here, far below what matters.
constexpr float kTie = 2e-6f, kTieFloor = 1e-7f;

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

// Of one point, in every lane, from a block's triangles.
PATINA_INLINE Lanes squaredDistance(const TriangleBlock& t, const Points& p) {
  const Lanes rx = p.x - load(t.a[0]), ry = p.y - load(t.a[1]), rz = p.z - load(t.a[2]);
  const Lanes ux = load(t.along[0]), uy = load(t.along[1]), uz = load(t.along[2]);
  const Lanes vx = load(t.across[0]), vy = load(t.across[1]), vz = load(t.across[2]);
  const Lanes x = madd(rx, ux, madd(ry, uy, rz * uz));
  const Lanes y = madd(rx, vx, madd(ry, vy, rz * vz));
  const Lanes z =
      madd(rx, uy * vz - uz * vy, madd(ry, uz * vx - ux * vz, rz * (ux * vy - uy * vx)));
  const Lanes zero = spread(0.0f), one = spread(1.0f);
  const Lanes ab = load(t.ab), cx = load(t.c_x), cy = load(t.c_y);
  const Lanes from_b = x - ab, bc_x = cx - ab;
  const Lanes on_bc = smaller(larger(madd(from_b, bc_x, y * cy) * load(t.per_bc2), zero), one);
  const Lanes on_ac = smaller(larger(madd(x, cx, y * cy) * load(t.per_ac2), zero), one);
  const Lanes over_ab = x - smaller(larger(x, zero), ab);
  const Lanes bc_dx = from_b - on_bc * bc_x, bc_dy = y - on_bc * cy;
  const Lanes ac_dx = x - on_ac * cx, ac_dy = y - on_ac * cy;
  const Lanes edge =
      smaller(madd(over_ab, over_ab, y * y),
              smaller(madd(bc_dx, bc_dx, bc_dy * bc_dy), madd(ac_dx, ac_dx, ac_dy * ac_dy)));
  const Mask inside = smaller(y, smaller(x * cy - y * cx, y * bc_x - from_b * cy)) > zero;
  return madd(z, z, choose(inside, zero, edge));
}

struct Answer {
  Lanes best, limit, face_d2;
  IntLanes face, triangle;
  float max_limit;
};

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

// Of one point.
struct Nearest {
  float best, limit, face_d2;
  std::int32_t face, triangle;
};

// Of one point, in every lane, from one triangle.
PATINA_INLINE Lanes squaredDistance(const PacketTriangle& t, const Points& p) {
  return squaredDistance(OneTriangle{t}, p.x - spread(t.a[0]), p.y - spread(t.a[1]),
                         p.z - spread(t.a[2]));
}

PATINA_INLINE void take(const PacketTriangle* triangles, std::int32_t index, float d2,
                        Nearest& nearest) {
  if (d2 < nearest.best) {
    nearest.best = d2;
    const float limit = __builtin_sqrtf(d2) * (1 + kTie) + kTieFloor;
    nearest.limit = limit * limit;
  }
  const std::int32_t face = triangles[index].face;
  if (face < nearest.face || nearest.limit < nearest.face_d2) {
    nearest.face = face;
    nearest.face_d2 = d2;
    nearest.triangle = index;
  }
}

// `child` are the triangles, as ~index.
PATINA_INLINE void take(const PacketTriangle* triangles, const Lanes& d2, const std::int32_t* child,
                        Nearest& nearest) {
  unsigned near = bits(d2 <= spread(nearest.limit));
  if (!near) return;
  alignas(32) float distance[kWide];
  store(distance, d2);
  while (near) {
    const int i = __builtin_ctz(near);
    near &= near - 1;
    if (distance[i] <= nearest.limit) take(triangles, ~child[i], distance[i], nearest);
  }
}

PATINA_INLINE void tryTriangle(const PacketTriangle* triangles, std::int32_t index, const Points& p,
                               Nearest& nearest) {
  const float d2 = first(squaredDistance(triangles[index], p));
  if (d2 <= nearest.limit) take(triangles, index, d2, nearest);
}

} // namespace patina::PATINA_KERNEL
