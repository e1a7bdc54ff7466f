// Parts of the packet kernel (see triangle_packet_kernel.h), in this order: lanes, lower bounds of
// distances to nodes, distances to triangles, the best answers so far.
#pragma once

#include <cstdint>

#include "geometry/tree/triangle_packet.h"

#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif
#define PATINA_INLINE static inline __attribute__((always_inline))
#define PATINA_MEMBER inline __attribute__((always_inline))

namespace patina::PATINA_KERNEL {

// Eight lanes of float or int: one AVX register, or two registers of four lanes. Included by the
// packet kernel only; everything lives in its PATINA_KERNEL namespace.
#if defined(__AVX2__) && defined(__FMA__)

struct Lanes {
  __m256 v;
};
struct Mask {
  __m256 v;
};
struct IntLanes {
  __m256i v;
};

PATINA_INLINE Lanes broadcast(float x) {
  return {_mm256_set1_ps(x)};
}
PATINA_INLINE IntLanes broadcast(std::int32_t x) {
  return {_mm256_set1_epi32(x)};
}
PATINA_INLINE Lanes load(const float* p) {
  return {_mm256_load_ps(p)};
}
PATINA_INLINE IntLanes load(const std::int32_t* p) {
  return {_mm256_load_si256(reinterpret_cast<const __m256i*>(p))};
}
PATINA_INLINE void store(float* p, const Lanes& a) {
  _mm256_store_ps(p, a.v);
}
PATINA_INLINE void store(std::int32_t* p, const IntLanes& a) {
  _mm256_store_si256(reinterpret_cast<__m256i*>(p), a.v);
}
PATINA_INLINE Lanes operator-(const Lanes& a, const Lanes& b) {
  return {_mm256_sub_ps(a.v, b.v)};
}
PATINA_INLINE Lanes operator+(const Lanes& a, const Lanes& b) {
  return {_mm256_add_ps(a.v, b.v)};
}
PATINA_INLINE Lanes abs(const Lanes& a) {
  return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)};
}
PATINA_INLINE Lanes operator*(const Lanes& a, const Lanes& b) {
  return {_mm256_mul_ps(a.v, b.v)};
}
PATINA_INLINE Lanes madd(const Lanes& a, const Lanes& b, const Lanes& c) {
  return {_mm256_fmadd_ps(a.v, b.v, c.v)};
}
PATINA_INLINE Lanes min(const Lanes& a, const Lanes& b) {
  return {_mm256_min_ps(a.v, b.v)};
}
PATINA_INLINE Lanes max(const Lanes& a, const Lanes& b) {
  return {_mm256_max_ps(a.v, b.v)};
}
PATINA_INLINE Lanes sqrt(const Lanes& a) {
  return {_mm256_sqrt_ps(a.v)};
}
PATINA_INLINE Mask operator<=(const Lanes& a, const Lanes& b) {
  return {_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)};
}
PATINA_INLINE Mask operator<(const Lanes& a, const Lanes& b) {
  return {_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)};
}
PATINA_INLINE Mask operator>(const Lanes& a, const Lanes& b) {
  return b < a;
}
PATINA_INLINE Mask operator<(const IntLanes& a, const IntLanes& b) {
  return {_mm256_castsi256_ps(_mm256_cmpgt_epi32(b.v, a.v))};
}
PATINA_INLINE Mask operator&(const Mask& a, const Mask& b) {
  return {_mm256_and_ps(a.v, b.v)};
}
PATINA_INLINE Mask operator|(const Mask& a, const Mask& b) {
  return {_mm256_or_ps(a.v, b.v)};
}
PATINA_INLINE Lanes select(const Mask& m, const Lanes& yes, const Lanes& no) {
  return {_mm256_blendv_ps(no.v, yes.v, m.v)};
}
PATINA_INLINE IntLanes select(const Mask& m, const IntLanes& yes, const IntLanes& no) {
  return {_mm256_castps_si256(
      _mm256_blendv_ps(_mm256_castsi256_ps(no.v), _mm256_castsi256_ps(yes.v), m.v))};
}
PATINA_INLINE unsigned bits(const Mask& m) {
  return static_cast<unsigned>(_mm256_movemask_ps(m.v));
}
PATINA_INLINE float reduceMax(const Lanes& a) {
  __m128 m = _mm_max_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  m = _mm_max_ps(m, _mm_movehl_ps(m, m));
  m = _mm_max_ss(m, _mm_shuffle_ps(m, m, 1));
  return _mm_cvtss_f32(m);
}

PATINA_INLINE float reduceMin(const Lanes& a) {
  __m128 m = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  m = _mm_min_ps(m, _mm_movehl_ps(m, m));
  m = _mm_min_ss(m, _mm_shuffle_ps(m, m, 1));
  return _mm_cvtss_f32(m);
}
PATINA_INLINE float first(const Lanes& a) {
  return _mm256_cvtss_f32(a.v);
}

// Sets column[i] to element i of each of the eight rows.
PATINA_INLINE void transpose(const float* const (&row)[8], Lanes* column) {
  __m256 r[8], s[8];
  for (int i = 0; i < 8; ++i) r[i] = _mm256_load_ps(row[i]);
  for (int i = 0; i < 8; i += 2) {
    s[i] = _mm256_unpacklo_ps(r[i], r[i + 1]);
    s[i + 1] = _mm256_unpackhi_ps(r[i], r[i + 1]);
  }
  for (int i = 0; i < 8; i += 4) {
    r[i] = _mm256_shuffle_ps(s[i], s[i + 2], 0x44);
    r[i + 1] = _mm256_shuffle_ps(s[i], s[i + 2], 0xEE);
    r[i + 2] = _mm256_shuffle_ps(s[i + 1], s[i + 3], 0x44);
    r[i + 3] = _mm256_shuffle_ps(s[i + 1], s[i + 3], 0xEE);
  }
  for (int i = 0; i < 4; ++i) {
    column[i].v = _mm256_permute2f128_ps(r[i], r[i + 4], 0x20);
    column[i + 4].v = _mm256_permute2f128_ps(r[i], r[i + 4], 0x31);
  }
}

#else

typedef float Four __attribute__((vector_size(16)));
typedef std::int32_t IntFour __attribute__((vector_size(16)));

struct Lanes {
  Four a, b;
};
struct Mask {
  IntFour a, b;
};
struct IntLanes {
  IntFour a, b;
};

PATINA_INLINE Lanes broadcast(float x) {
  const Four f = {x, x, x, x};
  return {f, f};
}
PATINA_INLINE IntLanes broadcast(std::int32_t x) {
  const IntFour f = {x, x, x, x};
  return {f, f};
}
PATINA_INLINE Lanes load(const float* p) {
  const Four* f = reinterpret_cast<const Four*>(p);
  return {f[0], f[1]};
}
PATINA_INLINE IntLanes load(const std::int32_t* p) {
  const IntFour* f = reinterpret_cast<const IntFour*>(p);
  return {f[0], f[1]};
}
PATINA_INLINE void store(float* p, const Lanes& a) {
  Four* f = reinterpret_cast<Four*>(p);
  f[0] = a.a;
  f[1] = a.b;
}
PATINA_INLINE void store(std::int32_t* p, const IntLanes& a) {
  IntFour* f = reinterpret_cast<IntFour*>(p);
  f[0] = a.a;
  f[1] = a.b;
}
PATINA_INLINE Lanes operator-(const Lanes& x, const Lanes& y) {
  return {x.a - y.a, x.b - y.b};
}
PATINA_INLINE Lanes operator+(const Lanes& x, const Lanes& y) {
  return {x.a + y.a, x.b + y.b};
}
PATINA_INLINE Lanes abs(const Lanes& x) {
  const IntFour m = {0x7fffffff, 0x7fffffff, 0x7fffffff, 0x7fffffff};
  return {reinterpret_cast<Four>(reinterpret_cast<IntFour>(x.a) & m),
          reinterpret_cast<Four>(reinterpret_cast<IntFour>(x.b) & m)};
}
PATINA_INLINE Lanes operator*(const Lanes& x, const Lanes& y) {
  return {x.a * y.a, x.b * y.b};
}
PATINA_INLINE Lanes madd(const Lanes& x, const Lanes& y, const Lanes& z) {
  return {x.a * y.a + z.a, x.b * y.b + z.b};
}
PATINA_INLINE Lanes min(const Lanes& x, const Lanes& y) {
#if defined(__SSE__)
  return {__builtin_ia32_minps(x.a, y.a), __builtin_ia32_minps(x.b, y.b)};
#else
  return {x.a < y.a ? x.a : y.a, x.b < y.b ? x.b : y.b};
#endif
}
PATINA_INLINE Lanes max(const Lanes& x, const Lanes& y) {
#if defined(__SSE__)
  return {__builtin_ia32_maxps(x.a, y.a), __builtin_ia32_maxps(x.b, y.b)};
#else
  return {x.a > y.a ? x.a : y.a, x.b > y.b ? x.b : y.b};
#endif
}
PATINA_INLINE Lanes sqrt(const Lanes& x) {
#if defined(__SSE__)
  return {__builtin_ia32_sqrtps(x.a), __builtin_ia32_sqrtps(x.b)};
#else
  Lanes r = x;
  for (int i = 0; i < 4; ++i) {
    r.a[i] = __builtin_sqrtf(x.a[i]);
    r.b[i] = __builtin_sqrtf(x.b[i]);
  }
  return r;
#endif
}
PATINA_INLINE Mask operator<=(const Lanes& x, const Lanes& y) {
  return {x.a <= y.a, x.b <= y.b};
}
PATINA_INLINE Mask operator<(const Lanes& x, const Lanes& y) {
  return {x.a < y.a, x.b < y.b};
}
PATINA_INLINE Mask operator>(const Lanes& x, const Lanes& y) {
  return {x.a > y.a, x.b > y.b};
}
PATINA_INLINE Mask operator<(const IntLanes& x, const IntLanes& y) {
  return {x.a < y.a, x.b < y.b};
}
PATINA_INLINE Mask operator&(const Mask& x, const Mask& y) {
  return {x.a & y.a, x.b & y.b};
}
PATINA_INLINE Mask operator|(const Mask& x, const Mask& y) {
  return {x.a | y.a, x.b | y.b};
}
PATINA_INLINE Lanes select(const Mask& m, const Lanes& yes, const Lanes& no) {
  return {m.a ? yes.a : no.a, m.b ? yes.b : no.b};
}
PATINA_INLINE IntLanes select(const Mask& m, const IntLanes& yes, const IntLanes& no) {
  return {m.a ? yes.a : no.a, m.b ? yes.b : no.b};
}
PATINA_INLINE unsigned bits(const Mask& m) {
#if defined(__SSE__)
  return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<Four>(m.a)) |
                               __builtin_ia32_movmskps(reinterpret_cast<Four>(m.b)) << 4);
#else
  unsigned r = 0;
  for (int i = 0; i < 4; ++i) {
    r |= static_cast<unsigned>(m.a[i] & 1) << i;
    r |= static_cast<unsigned>(m.b[i] & 1) << (i + 4);
  }
  return r;
#endif
}
// Sets column[i] to element i of each of the eight rows.
PATINA_INLINE void transpose(const float* const (&row)[8], Lanes* column) {
  for (int i = 0; i < 8; ++i) {
    column[i].a = Four{row[0][i], row[1][i], row[2][i], row[3][i]};
    column[i].b = Four{row[4][i], row[5][i], row[6][i], row[7][i]};
  }
}
PATINA_INLINE float reduceMax(const Lanes& x) {
  float m = x.a[0];
  for (int i = 0; i < 4; ++i) {
    m = x.a[i] > m ? x.a[i] : m;
    m = x.b[i] > m ? x.b[i] : m;
  }
  return m;
}

PATINA_INLINE float reduceMin(const Lanes& x) {
  float m = x.a[0];
  for (int i = 0; i < 4; ++i) {
    m = x.a[i] < m ? x.a[i] : m;
    m = x.b[i] < m ? x.b[i] : m;
  }
  return m;
}
PATINA_INLINE float first(const Lanes& x) {
  return x.a[0];
}

#endif

PATINA_INLINE bool any(const Mask& m) {
  return bits(m) != 0;
}

// Lower bounds of distances to nodes.

constexpr float kPadding = 2.5e-7f; // grows boxes by the rounding of float coordinates

struct Points {
  Lanes x, y, z;
};

PATINA_INLINE Lanes lengthSquared(const Lanes& x, const Lanes& y, const Lanes& z) {
  return madd(x, x, madd(y, y, z * z));
}

// An axis-aligned box, every coordinate in all lanes.
struct Box {
  Lanes centre[3], half[3];
};

PATINA_INLINE Box boxOf(const float (&lo)[3], const float (&hi)[3]) {
  Box box;
  for (int a = 0; a < 3; ++a) {
    box.centre[a] = broadcast(0.5f * (lo[a] + hi[a]));
    box.half[a] = broadcast(0.5f * (hi[a] - lo[a]) + kPadding);
  }
  return box;
}

PATINA_INLINE Lanes gap(const Lanes& offset, const Lanes& half) {
  return max(abs(offset) - half, broadcast(0.0f));
}

// Returns squared distances of eight boxes from one.
template <typename Rows>
PATINA_INLINE Lanes boxDistances(const Rows& centre, const Rows& half, const Box& box) {
  return lengthSquared(gap(load(centre[0]) - box.centre[0], load(half[0]) + box.half[0]),
                       gap(load(centre[1]) - box.centre[1], load(half[1]) + box.half[1]),
                       gap(load(centre[2]) - box.centre[2], load(half[2]) + box.half[2]));
}

// Returns lower bounds of squared distances; (x, y, z) are relative to the cylinders' centres.
PATINA_INLINE Lanes cylinderDistance(const Lanes& x, const Lanes& y, const Lanes& z,
                                     const Lanes& nx, const Lanes& ny, const Lanes& nz,
                                     const Lanes& low, const Lanes& high, const Lanes& radius) {
  const Lanes zero = broadcast(0.0f);
  const Lanes along = madd(x, nx, madd(y, ny, z * nz));
  // A difference of squares would lose the width of a thin rod.
  const Lanes across = sqrt(lengthSquared(x - along * nx, y - along * ny, z - along * nz));
  const Lanes over = max(max(along - high, low - along), zero);
  const Lanes out = max(across - radius, zero);
  return broadcast(1 - 1e-5f) * madd(over, over, out * out);
}

// Returns distances of eight points from one child.
PATINA_INLINE Lanes childDistance(const WideNode& node, int slot, const Points& p) {
  const Lanes x = p.x - broadcast(node.centre[0][slot]);
  const Lanes y = p.y - broadcast(node.centre[1][slot]);
  const Lanes z = p.z - broadcast(node.centre[2][slot]);
  const Lanes box =
      lengthSquared(gap(x, broadcast(node.half[0][slot])), gap(y, broadcast(node.half[1][slot])),
                    gap(z, broadcast(node.half[2][slot])));
  return max(box, cylinderDistance(x, y, z, broadcast(node.normal[0][slot]),
                                   broadcast(node.normal[1][slot]), broadcast(node.normal[2][slot]),
                                   broadcast(node.low[slot]), broadcast(node.high[slot]),
                                   broadcast(node.radius[slot])));
}

// Returns distances of one point, repeated in every lane, from eight children.
PATINA_INLINE Lanes childDistances(const WideNode& node, const Points& p) {
  const Lanes x = p.x - load(node.centre[0]);
  const Lanes y = p.y - load(node.centre[1]);
  const Lanes z = p.z - load(node.centre[2]);
  const Lanes box = lengthSquared(gap(x, load(node.half[0])), gap(y, load(node.half[1])),
                                  gap(z, load(node.half[2])));
  const Lanes radius = load(node.radius);
  if (!any(radius < broadcast(__builtin_inff()))) return box;
  return max(box, cylinderDistance(x, y, z, load(node.normal[0]), load(node.normal[1]),
                                   load(node.normal[2]), load(node.low), load(node.high), radius));
}

// Distances that differ by less are ties, which the lower face wins: relative, and in tree units.
// Above the rounding of float and far below relevant differences.
constexpr float kTie = 2e-6f, kTieFloor = 1e-7f;

// One triangle repeated in every lane, or eight triangles.
struct OneTriangle {
  const PacketTriangle& t;
  PATINA_MEMBER Lanes a(int i) const { return broadcast(t.a[i]); }
  PATINA_MEMBER Lanes axis(int i, int j) const { return broadcast(t.axis[i][j]); }
  PATINA_MEMBER Lanes ab() const { return broadcast(t.ab); }
  PATINA_MEMBER Lanes bcX() const { return broadcast(t.bc_x); }
  PATINA_MEMBER Lanes bcY() const { return broadcast(t.bc_y); }
  PATINA_MEMBER Lanes bcAlong() const { return broadcast(t.bc_along); }
  PATINA_MEMBER Lanes bcAcross() const { return broadcast(t.bc_across); }
  PATINA_MEMBER Lanes bc() const { return broadcast(t.bc); }
  PATINA_MEMBER Lanes acX() const { return broadcast(t.ac_x); }
  PATINA_MEMBER Lanes acY() const { return broadcast(t.ac_y); }
  PATINA_MEMBER Lanes ac() const { return broadcast(t.ac); }
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

// Returns the squared distance of points given relative to the triangle's corner A.
template <typename T>
PATINA_INLINE Lanes squaredDistance(const T& t, const Lanes& rx, const Lanes& ry, const Lanes& rz) {
  const Lanes x = madd(rx, t.axis(0, 0), madd(ry, t.axis(0, 1), rz * t.axis(0, 2)));
  const Lanes y = madd(rx, t.axis(1, 0), madd(ry, t.axis(1, 1), rz * t.axis(1, 2)));
  const Lanes z = madd(rx, t.axis(2, 0), madd(ry, t.axis(2, 1), rz * t.axis(2, 2)));
  const Lanes zero = broadcast(0.0f);
  const Lanes along1 = madd(x, t.bcX(), madd(y, t.bcY(), t.bcAlong()));
  const Lanes across1 = madd(y, t.bcX(), t.bcAcross() - x * t.bcY());
  const Lanes along2 = madd(x, t.acX(), y * t.acY());
  const Lanes across2 = x * t.acY() - y * t.acX();
  const Lanes over0 = x - min(max(x, zero), t.ab());
  const Lanes over1 = along1 - min(max(along1, zero), t.bc());
  const Lanes over2 = along2 - min(max(along2, zero), t.ac());
  const Lanes edge0 = madd(over0, over0, y * y);
  const Lanes edge1 = madd(over1, over1, across1 * across1);
  const Lanes edge2 = madd(over2, over2, across2 * across2);
  // Strictly inside, because a triangle without area has no inside.
  const Mask inside = min(y, min(across1, across2)) > zero;
  const Lanes edge = min(edge0, min(edge1, edge2));
  return madd(z, z, select(inside, zero, edge));
}

// Returns distances of one point, repeated in every lane, from a block's triangles.
PATINA_INLINE Lanes squaredDistance(const TriangleBlock& t, const Points& p) {
  const Lanes rx = p.x - load(t.a[0]), ry = p.y - load(t.a[1]), rz = p.z - load(t.a[2]);
  const Lanes ux = load(t.along[0]), uy = load(t.along[1]), uz = load(t.along[2]);
  const Lanes vx = load(t.across[0]), vy = load(t.across[1]), vz = load(t.across[2]);
  const Lanes x = madd(rx, ux, madd(ry, uy, rz * uz));
  const Lanes y = madd(rx, vx, madd(ry, vy, rz * vz));
  const Lanes z =
      madd(rx, uy * vz - uz * vy, madd(ry, uz * vx - ux * vz, rz * (ux * vy - uy * vx)));
  const Lanes zero = broadcast(0.0f), one = broadcast(1.0f);
  const Lanes ab = load(t.ab), cx = load(t.c_x), cy = load(t.c_y);
  const Lanes from_b = x - ab, bc_x = cx - ab;
  const Lanes on_bc = min(max(madd(from_b, bc_x, y * cy) * load(t.per_bc2), zero), one);
  const Lanes on_ac = min(max(madd(x, cx, y * cy) * load(t.per_ac2), zero), one);
  const Lanes over_ab = x - min(max(x, zero), ab);
  const Lanes bc_dx = from_b - on_bc * bc_x, bc_dy = y - on_bc * cy;
  const Lanes ac_dx = x - on_ac * cx, ac_dy = y - on_ac * cy;
  const Lanes edge = min(madd(over_ab, over_ab, y * y),
                         min(madd(bc_dx, bc_dx, bc_dy * bc_dy), madd(ac_dx, ac_dx, ac_dy * ac_dy)));
  const Mask inside = min(y, min(x * cy - y * cx, y * bc_x - from_b * cy)) > zero;
  return madd(z, z, select(inside, zero, edge));
}

struct Answer {
  Lanes best, limit, face_d2;
  IntLanes face, triangle;
  float max_limit;
};

// Largest squared distance that is a tie with `best`.
PATINA_INLINE Lanes tieLimit(const Lanes& best) {
  const Lanes limit = madd(sqrt(best), broadcast(1 + kTie), broadcast(kTieFloor));
  return limit * limit;
}

PATINA_INLINE void tryTriangle(const PacketTriangle* triangles, std::int32_t index, const Points& p,
                               Answer& answer) {
  const PacketTriangle& t = triangles[index];
  const Lanes d2 = squaredDistance(OneTriangle{t}, p.x - broadcast(t.a[0]), p.y - broadcast(t.a[1]),
                                   p.z - broadcast(t.a[2]));
  if (!any(d2 <= answer.limit)) return;
  answer.best = min(answer.best, d2);
  answer.limit = tieLimit(answer.best);
  const Mask take =
      (d2 <= answer.limit) & ((broadcast(t.face) < answer.face) | (answer.limit < answer.face_d2));
  answer.face = select(take, broadcast(t.face), answer.face);
  answer.triangle = select(take, broadcast(index), answer.triangle);
  answer.face_d2 = select(take, d2, answer.face_d2);
  answer.max_limit = reduceMax(answer.limit);
}

// Best answer for one point.
struct Nearest {
  float best, limit, face_d2;
  std::int32_t face, triangle;
};

// Returns the distance of one point, repeated in every lane, from one triangle.
PATINA_INLINE Lanes squaredDistance(const PacketTriangle& t, const Points& p) {
  return squaredDistance(OneTriangle{t}, p.x - broadcast(t.a[0]), p.y - broadcast(t.a[1]),
                         p.z - broadcast(t.a[2]));
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

// `child`: the triangles, as ~index.
PATINA_INLINE void take(const PacketTriangle* triangles, const Lanes& d2, const std::int32_t* child,
                        Nearest& nearest) {
  unsigned near = bits(d2 <= broadcast(nearest.limit));
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
