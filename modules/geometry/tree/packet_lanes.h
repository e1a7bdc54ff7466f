// Eight lanes of float or int: one AVX register, or two registers of four lanes. Included by the
// packet kernel only; everything lives in its PATINA_KERNEL namespace.
#pragma once

#include <cstdint>

#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif

#define PATINA_INLINE static inline __attribute__((always_inline))
#define PATINA_MEMBER inline __attribute__((always_inline))

namespace patina::PATINA_KERNEL {

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

PATINA_INLINE Lanes spread(float x) {
  return {_mm256_set1_ps(x)};
}
PATINA_INLINE IntLanes spread(std::int32_t x) {
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
PATINA_INLINE Lanes magnitude(const Lanes& a) {
  return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)};
}
PATINA_INLINE Lanes operator*(const Lanes& a, const Lanes& b) {
  return {_mm256_mul_ps(a.v, b.v)};
}
PATINA_INLINE Lanes madd(const Lanes& a, const Lanes& b, const Lanes& c) {
  return {_mm256_fmadd_ps(a.v, b.v, c.v)};
}
PATINA_INLINE Lanes smaller(const Lanes& a, const Lanes& b) {
  return {_mm256_min_ps(a.v, b.v)};
}
PATINA_INLINE Lanes larger(const Lanes& a, const Lanes& b) {
  return {_mm256_max_ps(a.v, b.v)};
}
PATINA_INLINE Lanes root(const Lanes& a) {
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
PATINA_INLINE Lanes choose(const Mask& m, const Lanes& yes, const Lanes& no) {
  return {_mm256_blendv_ps(no.v, yes.v, m.v)};
}
PATINA_INLINE IntLanes choose(const Mask& m, const IntLanes& yes, const IntLanes& no) {
  return {_mm256_castps_si256(
      _mm256_blendv_ps(_mm256_castsi256_ps(no.v), _mm256_castsi256_ps(yes.v), m.v))};
}
PATINA_INLINE unsigned bits(const Mask& m) {
  return static_cast<unsigned>(_mm256_movemask_ps(m.v));
}
PATINA_INLINE float largest(const Lanes& a) {
  __m128 m = _mm_max_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  m = _mm_max_ps(m, _mm_movehl_ps(m, m));
  m = _mm_max_ss(m, _mm_shuffle_ps(m, m, 1));
  return _mm_cvtss_f32(m);
}

PATINA_INLINE float smallest(const Lanes& a) {
  __m128 m = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  m = _mm_min_ps(m, _mm_movehl_ps(m, m));
  m = _mm_min_ss(m, _mm_shuffle_ps(m, m, 1));
  return _mm_cvtss_f32(m);
}
PATINA_INLINE float first(const Lanes& a) {
  return _mm256_cvtss_f32(a.v);
}

// column[i] = element i of each of the eight rows.
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

PATINA_INLINE Lanes spread(float x) {
  const Four f = {x, x, x, x};
  return {f, f};
}
PATINA_INLINE IntLanes spread(std::int32_t x) {
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
PATINA_INLINE Lanes magnitude(const Lanes& x) {
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
PATINA_INLINE Lanes smaller(const Lanes& x, const Lanes& y) {
#if defined(__SSE__)
  return {__builtin_ia32_minps(x.a, y.a), __builtin_ia32_minps(x.b, y.b)};
#else
  return {x.a < y.a ? x.a : y.a, x.b < y.b ? x.b : y.b};
#endif
}
PATINA_INLINE Lanes larger(const Lanes& x, const Lanes& y) {
#if defined(__SSE__)
  return {__builtin_ia32_maxps(x.a, y.a), __builtin_ia32_maxps(x.b, y.b)};
#else
  return {x.a > y.a ? x.a : y.a, x.b > y.b ? x.b : y.b};
#endif
}
PATINA_INLINE Lanes root(const Lanes& x) {
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
PATINA_INLINE Lanes choose(const Mask& m, const Lanes& yes, const Lanes& no) {
  return {m.a ? yes.a : no.a, m.b ? yes.b : no.b};
}
PATINA_INLINE IntLanes choose(const Mask& m, const IntLanes& yes, const IntLanes& no) {
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
// column[i] = element i of each of the eight rows.
PATINA_INLINE void transpose(const float* const (&row)[8], Lanes* column) {
  for (int i = 0; i < 8; ++i) {
    column[i].a = Four{row[0][i], row[1][i], row[2][i], row[3][i]};
    column[i].b = Four{row[4][i], row[5][i], row[6][i], row[7][i]};
  }
}
PATINA_INLINE float largest(const Lanes& x) {
  float m = x.a[0];
  for (int i = 0; i < 4; ++i) {
    m = x.a[i] > m ? x.a[i] : m;
    m = x.b[i] > m ? x.b[i] : m;
  }
  return m;
}

PATINA_INLINE float smallest(const Lanes& x) {
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

} // namespace patina::PATINA_KERNEL
