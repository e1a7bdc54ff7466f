// For times across several threads and programs, which no one thread's share of a core can judge.
#pragma once

#include <cstdlib>
#include <thread>

namespace patina {

// More wants to run here than there are processors. False where that is unknown.
inline bool machineIsCrowded() {
  double load = 0;
  return getloadavg(&load, 1) == 1 && load > std::thread::hardware_concurrency();
}

} // namespace patina
