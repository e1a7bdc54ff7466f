// Memory of a process, and what a long test requires of it.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

#include "support/longer.h"

namespace patina::test {

inline std::size_t residentBytes(const std::string& process = "self") {
  std::size_t all = 0, resident = 0;
  std::ifstream("/proc/" + process + "/statm") >> all >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// Seconds of a test that runs long: PATINA_MINUTES if set, else by PATINA_LONG.
inline double longSeconds(double brief, double full) {
  const char* minutes = std::getenv("PATINA_MINUTES");
  return minutes != nullptr ? 60 * std::atof(minutes) : isLong() ? full : brief;
}

// Growth from the second quarter of the samples to the last, between their largest [bytes]; the
// first quarter warms up.
inline double growth(const std::vector<std::size_t>& samples) {
  const std::size_t quarter = samples.size() / 4;
  const auto most = [&](std::size_t from, std::size_t to) {
    return static_cast<double>(
        *std::max_element(samples.begin() + static_cast<std::ptrdiff_t>(from),
                          samples.begin() + static_cast<std::ptrdiff_t>(to)));
  };
  const double before = most(quarter, 2 * quarter), after = most(3 * quarter, samples.size());
  std::printf("resident %.1f MB, then %.1f MB\n", before / 1e6, after / 1e6);
  return after - before;
}

} // namespace patina::test
