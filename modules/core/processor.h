// Processor features beyond the baseline of the build.
#pragma once

namespace patina {

// Features that the sources named *_avx2.cpp require.
inline bool hasAvx2() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

} // namespace patina
