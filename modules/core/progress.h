// Progress and cancel of a long operation. Thread-safe: workers report and poll, any thread
// cancels.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string_view>

#include "core/error.h"

namespace patina {

class Progress {
 public:
  // Called with a fraction in [0, 1] and a phrase ("distances"); never from two threads at once.
  using Listener = std::function<void(double fraction, std::string_view what)>;

  Progress() = default;
  explicit Progress(Listener listener) : listener_(std::move(listener)) {}
  // One step of a longer operation: cancelled when that is.
  Progress(const Progress& whole, Listener listener)
      : listener_(std::move(listener)), whole_(&whole) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void report(double fraction, std::string_view what) {
    if (!listener_) return;
    const std::lock_guard lock(mutex_);
    listener_(fraction, what);
  }
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept {
    return cancelled_.load(std::memory_order_relaxed) || (whole_ && whole_->cancelled());
  }
  void throwIfCancelled() const {
    if (cancelled()) throw Cancelled();
  }

 private:
  Listener listener_;
  const Progress* whole_ = nullptr;
  std::mutex mutex_;
  std::atomic<bool> cancelled_{false};
};

} // namespace patina
