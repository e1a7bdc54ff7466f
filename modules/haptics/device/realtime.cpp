#include "haptics/device/realtime.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <time.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace patina {
namespace {

constexpr int kPriority = 50;
constexpr std::int64_t kSecond = 1'000'000'000;

// Touched pages stay mapped; the servo's stack frames are far smaller.
[[gnu::noinline]] void prefaultStack() {
  volatile char page_touch[64 * 1024];
  for (std::size_t i = 0; i < sizeof(page_touch); i += 1024) page_touch[i] = 0;
}

} // namespace

std::int64_t monotonicNs() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

std::int64_t periodNs(double rate_hz) {
  if (!(rate_hz >= 100 && rate_hz <= 10000))
    throw std::invalid_argument("servo rate must be between 100 and 10000 Hz");
  return static_cast<std::int64_t>(static_cast<double>(kSecond) / rate_hz);
}

void sleepUntil(std::int64_t monotonic_ns) noexcept {
  const timespec until{monotonic_ns / kSecond, monotonic_ns % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

RealtimeGrant requestRealtime() noexcept {
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  prefaultStack();
  sched_param parameter{};
  parameter.sched_priority = kPriority;
  RealtimeGrant grant;
  grant.fifo_error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  // ONFAULT keeps accessed pages in memory without reading in the whole program.
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) grant.lock_error = errno;
  return grant;
}

std::string policyText(const RealtimeGrant& grant) {
  if (grant.fifo_error < 0) return "not started";
  const auto reason = [](int error) { return std::string(std::strerror(error)); };
  std::string text = grant.fifo_error == 0
                         ? "SCHED_FIFO " + std::to_string(kPriority)
                         : "SCHED_OTHER (SCHED_FIFO refused: " + reason(grant.fifo_error) + ")";
  text += grant.lock_error == 0 ? ", memory locked"
                                : ", memory not locked: " + reason(grant.lock_error);
  return text;
}

} // namespace patina
