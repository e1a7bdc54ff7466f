// Part of the packet kernel (see triangle_packet_kernel.h): distances from triangles, and the
// running answers.
#pragma once

#include "geometry/packet_bounds.h"

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

// Squared distances of one point from `count` triangles; other lanes repeat the first.
PATINA_INLINE Lanes triangleDistances(const PacketTriangle* triangles, std::int32_t (&index)[kWide],
                                      int count, const Points& p) {
  if (count == 1) {
    const PacketTriangle& t = triangles[index[0]];
    return squaredDistance(OneTriangle{t}, p.x - spread(t.a[0]), p.y - spread(t.a[1]),
                           p.z - spread(t.a[2]));
  }
  for (int i = count; i < kWide; ++i) index[i] = index[0];
  EightTriangles t;
  gather(triangles, index, t);
  return squaredDistance(t, p.x - t.a(0), p.y - t.a(1), p.z - t.a(2));
}

PATINA_INLINE void tryTriangles(const PacketTriangle* triangles, std::int32_t (&index)[kWide],
                                int count, const Points& p, Nearest& nearest) {
  const Lanes d2 = triangleDistances(triangles, index, count, p);
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

} // namespace patina::PATINA_KERNEL
