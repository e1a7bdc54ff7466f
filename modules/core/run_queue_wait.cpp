#include "core/run_queue_wait.h"

#include <fcntl.h>
#include <unistd.h>

#include <charconv>

namespace patina {

RunQueueWait::RunQueueWait() noexcept
    : file_(open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC)) {}

RunQueueWait::~RunQueueWait() {
  if (file_ >= 0) close(file_);
}

std::optional<std::int64_t> RunQueueWait::total() const noexcept {
  char text[96];
  const ssize_t size = file_ < 0 ? -1 : pread(file_, text, sizeof text, 0);
  if (size <= 0) return std::nullopt;
  // Time on a processor [ns], time waiting for one [ns], times put on one.
  std::int64_t values[3] = {};
  const char* at = text;
  for (std::int64_t& value : values) {
    while (at != text + size && *at == ' ') ++at;
    const auto [end, error] = std::from_chars(at, text + size, value);
    if (error != std::errc()) return std::nullopt;
    at = end;
  }
  // A thread that runs was put on a processor: a kernel that does not count writes zeros.
  if (values[2] == 0) return std::nullopt;
  return values[1];
}

} // namespace patina
