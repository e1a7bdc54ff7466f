// The long form of tests that measure or use random paths.
#pragma once

#include <cstdlib>

namespace patina::test {

// PATINA_LONG=1 in the environment: ten times as many ticks, loops and rounds
// (docs/contributing.md).
inline bool isLong() {
  return std::getenv("PATINA_LONG") != nullptr;
}
inline long longer(long count) {
  return isLong() ? 10 * count : count;
}

} // namespace patina::test
