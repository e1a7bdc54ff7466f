#include "haptics/timing_window.h"

#include <algorithm>
#include <cmath>
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

TimingWindow::Percentiles
TimingWindow::percentiles(std::atomic<std::uint32_t> Entry::*member) const {
  const std::size_t filled = static_cast<std::size_t>(std::min<std::uint64_t>(count(), capacity_));
  if (filled == 0) return {};
  std::vector<std::uint32_t> values(filled);
  for (std::size_t i = 0; i < filled; ++i) {
    values[i] = (entries_[i].*member).load(std::memory_order_relaxed);
  }
  std::sort(values.begin(), values.end());
  // Nearest rank: the smallest value that at least the fraction of all does not exceed.
  const auto at = [&](double fraction) {
    const double rank = std::ceil(fraction * static_cast<double>(filled));
    return static_cast<double>(values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1]);
  };
  return {at(0.5), at(0.99), at(0.999), static_cast<double>(values.back())};
}

TimingWindow::Percentiles TimingWindow::late() const {
  return percentiles(&Entry::late);
}
TimingWindow::Percentiles TimingWindow::step() const {
  return percentiles(&Entry::step);
}

} // namespace patina
