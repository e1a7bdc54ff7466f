#include "core/timing_window.h"

#include <algorithm>
#include <limits>

namespace patina {
namespace {

std::uint32_t saturated(std::int64_t ns) noexcept {
  return static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(ns, 0, std::numeric_limits<std::uint32_t>::max()));
}

} // namespace

TimingWindow::TimingWindow(std::size_t capacity)
    : capacity_(std::max<std::size_t>(capacity, 1)),
      entries_(std::make_unique<Entry[]>(capacity_)) {}

void TimingWindow::record(std::int64_t late_ns, std::int64_t step_ns) noexcept {
  const std::uint64_t index = count_.load(std::memory_order_relaxed);
  Entry& entry = entries_[index % capacity_];
  entry.late.store(saturated(late_ns), std::memory_order_relaxed);
  entry.step.store(saturated(step_ns), std::memory_order_relaxed);
  count_.store(index + 1, std::memory_order_release);
}

Percentiles TimingWindow::percentiles(std::atomic<std::uint32_t> Entry::*member) const {
  std::vector<double> values(static_cast<std::size_t>(std::min<std::uint64_t>(count(), capacity_)));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = (entries_[i].*member).load(std::memory_order_relaxed);
  return patina::percentiles(std::move(values));
}

Percentiles TimingWindow::late() const {
  return percentiles(&Entry::late);
}
Percentiles TimingWindow::step() const {
  return percentiles(&Entry::step);
}

} // namespace patina
