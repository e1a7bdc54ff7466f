#include "core/timing_window.h"

#include <algorithm>

namespace patina {

TimingWindow::TimingWindow(std::size_t capacity)
    : capacity_(std::max<std::size_t>(capacity, 1)),
      late_(std::make_unique<std::atomic<std::uint32_t>[]>(capacity_)) {}

void TimingWindow::record(std::int64_t late_ns) noexcept {
  const std::uint64_t index = count_.load(std::memory_order_relaxed);
  late_[index % capacity_].store(
      static_cast<std::uint32_t>(std::clamp<std::int64_t>(late_ns, 0, UINT32_MAX)),
      std::memory_order_relaxed);
  count_.store(index + 1, std::memory_order_release);
}

Percentiles TimingWindow::late() const {
  std::vector<double> values(static_cast<std::size_t>(std::min<std::uint64_t>(count(), capacity_)));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = late_[i].load(std::memory_order_relaxed);
  return percentiles(std::move(values));
}

} // namespace patina
