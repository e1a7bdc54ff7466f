// Progress and cancellation of a long operation. Workers report and poll, any thread cancels.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string_view>

#include "core/error.h"

namespace patina {

class Progress {
 public:
  // Called with a fraction in [0, 1] and a phrase ("distances"), by one thread at a time.
  using Listener = std::function<void(double fraction, std::string_view what)>;

  Progress() = default;
  explicit Progress(Listener listener) : listener_(std::move(listener)) {}
  // Step of a longer operation; cancelling the parent cancels the step.
  Progress(const Progress& parent, Listener listener)
      : listener_(std::move(listener)), parent_(&parent) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void report(double fraction, std::string_view what) {
    if (!listener_) return;
    const std::lock_guard lock(mutex_);
    listener_(fraction, what);
  }
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept {
    return cancelled_.load(std::memory_order_relaxed) || (parent_ && parent_->cancelled());
  }
  void throwIfCancelled() const {
    if (cancelled()) throw Cancelled();
  }

 private:
  Listener listener_;
  const Progress* parent_ = nullptr;
  std::mutex mutex_;
  std::atomic<bool> cancelled_{false};
};

} // namespace patina
