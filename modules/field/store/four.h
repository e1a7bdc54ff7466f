// Vectors of four numbers: the compiler's portable vector types, for SSE and NEON.
#pragma once

#include <cstdint>
#include <cstring>

namespace patina {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16))); // comparison result: 0 or -1
using Double4 = double __attribute__((vector_size(32)));
using Double4At = double __attribute__((vector_size(32), aligned(8))); // aligned like a double
using Word4 = std::uint32_t __attribute__((vector_size(16)));

inline Float4 load(const float* from) {
  Float4 value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

inline Word4 load(const std::uint32_t* from) {
  Word4 value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

template <class Four> void store(Four value, void* to) {
  std::memcpy(to, &value, sizeof(value));
}

} // namespace patina
