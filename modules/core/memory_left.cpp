#include "core/memory_left.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sys/resource.h>
#include <unistd.h>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr std::size_t kUnknown = std::numeric_limits<std::size_t>::max();

std::size_t ofMachine() {
  std::ifstream info("/proc/meminfo");
  for (std::string key, unit; info >> key;) {
    std::size_t kilobytes = 0;
    if (info >> kilobytes; key == "MemAvailable:") return kilobytes * 1024;
    std::getline(info, unit);
  }
  return kUnknown;
}

std::size_t ofLimit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const std::size_t used = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

} // namespace

std::size_t memoryLeft() {
  return std::min(ofMachine(), ofLimit());
}

bool memoryIsLimited() {
  return ofLimit() != kUnknown;
}

void requireMemory(double bytes, const std::string& what, const std::string& advice) {
  const auto left = static_cast<double>(memoryLeft());
  if (bytes <= left) return;
  throw Error(what + " needs about " + formatBytes(bytes) + " of memory, and " + formatBytes(left) +
              " are left" + advice);
}

void requireRoomToLoad(const std::string& what) {
  constexpr double kTaken = 450e6; // address space of the largest library, measured [bytes]
  if (memoryIsLimited()) requireMemory(kTaken, what);
}

} // namespace patina
