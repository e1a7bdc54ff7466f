// The newest value of one thread for one other, without a lock: nobody waits, what is overtaken is
// never seen, and no value is ever read by half.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace patina {

template <typename Value> class Newest {
 public:
  // The writer's thread.
  void put(const Value& value) noexcept {
    slots_[write_] = value;
    write_ =
        middle_.exchange(static_cast<std::uint8_t>(write_ | kFresh), std::memory_order_acq_rel) &
        kSlot;
  }
  // The reader's thread: the newest, which may be that of the last time.
  const Value& get() noexcept {
    if (middle_.load(std::memory_order_relaxed) & kFresh)
      read_ = middle_.exchange(read_, std::memory_order_acq_rel) & kSlot;
    return slots_[read_];
  }

 private:
  static constexpr std::uint8_t kSlot = 3, kFresh = 4;

  std::array<Value, 3> slots_{}; // one to write, one in the middle, one to read
  std::uint8_t write_ = 0, read_ = 1;
  std::atomic<std::uint8_t> middle_{2};
};

} // namespace patina
