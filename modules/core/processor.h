// What this processor can do beyond what the whole program is compiled for.
#pragma once

namespace patina {

// What the sources named *_avx2.cpp are compiled for.
inline bool hasAvx2() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

} // namespace patina
