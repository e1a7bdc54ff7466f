// A wait that another thread can end.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace patina {

class StoppableTimer {
 public:
  // Waits until `seconds` after the first call of this or now(); returns false once stopped.
  bool waitUntil(double seconds) {
    std::unique_lock lock(mutex_);
    const auto due = beginning(lock) + std::chrono::duration<double>(seconds);
    changed_.wait_until(lock, std::chrono::time_point_cast<Clock::duration>(due),
                        [&] { return stopped_; });
    return !stopped_;
  }
  double now() {
    std::unique_lock lock(mutex_);
    return std::chrono::duration<double>(Clock::now() - beginning(lock)).count();
  }
  void stop() noexcept {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point beginning(const std::unique_lock<std::mutex>&) {
    if (!begun_) begin_ = Clock::now();
    begun_ = true;
    return begin_;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  Clock::time_point begin_;
  bool begun_ = false, stopped_ = false;
};

// Returns the first time of a scan folder's frames and samples, the start of a replay of either.
double replayStart(const std::string& folder, double first_frame);

} // namespace patina
