// The long form of tests that measure or wander.
#pragma once

#include <cstdlib>

namespace patina::test {

// PATINA_LONG=1 in the environment: ten times as many ticks, loops and rounds
// (docs/contributing.md).
inline long longer(long count) {
  return std::getenv("PATINA_LONG") ? 10 * count : count;
}

} // namespace patina::test
