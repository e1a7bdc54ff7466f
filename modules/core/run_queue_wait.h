// How long a thread was ready to run and had no processor, by the kernel's own account.
#pragma once

#include <cstdint>
#include <optional>

namespace patina {

class RunQueueWait {
 public:
  RunQueueWait() noexcept; // of the thread that makes it
  ~RunQueueWait();
  RunQueueWait(const RunQueueWait&) = delete;
  RunQueueWait& operator=(const RunQueueWait&) = delete;

  // Since the thread began [ns]; sleep does not count. Absent where the system keeps no account.
  // A call of the system, about a microsecond; neither allocates nor locks.
  std::optional<std::int64_t> total() const noexcept;

 private:
  int file_;
};

} // namespace patina
