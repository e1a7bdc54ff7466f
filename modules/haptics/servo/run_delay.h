// Time that a runnable thread waited for a processor (the kernel's run delay, schedstat).
#pragma once

#include <cstdint>
#include <optional>

namespace patina {

class RunDelay {
 public:
  RunDelay() noexcept; // measures the calling thread
  ~RunDelay();
  RunDelay(const RunDelay&) = delete;
  RunDelay& operator=(const RunDelay&) = delete;

  // Run delay since the thread began [ns], without sleep; absent if the kernel does not count it.
  // One system call of about a microsecond; neither allocates nor locks.
  std::optional<std::int64_t> total() const noexcept;

 private:
  int file_;
};

} // namespace patina
