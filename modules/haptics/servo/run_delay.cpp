#include "haptics/servo/run_delay.h"

#include <fcntl.h>
#include <unistd.h>

#include <charconv>

namespace patina {

RunDelay::RunDelay() noexcept : file_(open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC)) {}

RunDelay::~RunDelay() {
  if (file_ >= 0) close(file_);
}

std::optional<std::int64_t> RunDelay::total() const noexcept {
  char text[96];
  const ssize_t size = file_ < 0 ? -1 : pread(file_, text, sizeof text, 0);
  if (size <= 0) return std::nullopt;
  // Time on a processor [ns], run delay [ns], number of time slices.
  std::int64_t values[3] = {};
  const char* at = text;
  for (std::int64_t& value : values) {
    while (at != text + size && *at == ' ') ++at;
    const auto [end, error] = std::from_chars(at, text + size, value);
    if (error != std::errc()) return std::nullopt;
    at = end;
  }
  // A running thread had a time slice; a kernel that does not count writes zeros.
  if (values[2] == 0) return std::nullopt;
  return values[1];
}

} // namespace patina
