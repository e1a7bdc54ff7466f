// A bounded single-producer single-consumer queue. Neither side locks or allocates.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace patina {

template <typename T> class Ring {
  // Eigen's fixed vectors are not "trivially copyable"; it suffices that items own nothing.
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  // Rounds the capacity up to a power of two and allocates and touches all memory at once.
  explicit Ring(std::size_t capacity) {
    std::size_t size = 1;
    while (size < capacity) size *= 2;
    mask_ = size - 1;
    items_ = std::make_unique<T[]>(size);
  }

  // Producer. Returns false and counts the item in dropped() if the queue is full; never waits.
  bool push(const T& item) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) > mask_) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    items_[head & mask_] = item;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  // Consumer. Returns false if the queue is empty.
  bool pop(T& item) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    item = items_[tail & mask_];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  std::size_t capacity() const noexcept { return mask_ + 1; }
  std::size_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::unique_ptr<T[]> items_;
  std::size_t mask_ = 0;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
  alignas(64) std::atomic<std::size_t> dropped_{0};
};

} // namespace patina
