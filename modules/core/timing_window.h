// Wake-up latency of the last N ticks: the servo thread writes, any thread reads without a lock.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "core/percentiles.h"

namespace patina {

class TimingWindow {
 public:
  explicit TimingWindow(std::size_t capacity);

  // Servo thread. Saturates at 2^32 - 1 ns.
  void record(std::int64_t late_ns) noexcept;

  Percentiles late() const; // [ns]; any thread; zeros before the first tick
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_acquire); }

 private:
  std::size_t capacity_;
  std::unique_ptr<std::atomic<std::uint32_t>[]> late_;
  std::atomic<std::uint64_t> count_{0};
};

} // namespace patina
