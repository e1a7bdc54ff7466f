// Hands immutable values from a writer thread to one real-time reader, with hazard pointers
// (Michael 2004): the reader marks the value in use, and the writer frees only unmarked ones. The
// reader never locks, allocates or frees. std::atomic<std::shared_ptr> is not lock-free in g++ 12.
#pragma once

#include <atomic>
#include <memory>
#include <utility>
#include <vector>

namespace patina {

template <typename T> class SnapshotExchange {
 public:
  SnapshotExchange() = default;
  SnapshotExchange(const SnapshotExchange&) = delete;
  SnapshotExchange& operator=(const SnapshotExchange&) = delete;

  // Writer thread. The next latest() returns the value. Frees values that the reader has released.
  void publish(std::shared_ptr<const T> value) {
    const T* raw = value.get();
    kept_.push_back(std::move(value));
    newest_.store(raw, std::memory_order_seq_cst);
    collect();
  }

  // Writer thread. Frees replaced values that are not marked; returns the number of values alive.
  std::size_t collect() {
    // This order never misses a value that the reader moves from in_use_ to protected_.
    const T* in_use = in_use_.load(std::memory_order_seq_cst);
    const T* held = protected_.load(std::memory_order_seq_cst);
    const T* newest = newest_.load(std::memory_order_relaxed);
    std::erase_if(kept_, [&](const auto& item) {
      return item.get() != in_use && item.get() != held && item.get() != newest;
    });
    return kept_.size();
  }

  // Reader thread, wait-free in practice: the newest value, or nullptr before the first. It stays
  // valid until this thread's next call, or longer if protect() marks it before that.
  const T* latest() noexcept {
    const T* seen = newest_.load(std::memory_order_seq_cst);
    for (;;) {
      in_use_.store(seen, std::memory_order_seq_cst);
      // The writer may have freed `seen` before the mark was visible, so the loop checks again.
      const T* again = newest_.load(std::memory_order_seq_cst);
      if (again == seen) return seen;
      seen = again;
    }
  }

  // Reader thread, wait-free: marks a value, the last from latest() or the one marked already, as
  // in use until the next protect(). nullptr marks none.
  void protect(const T* value) noexcept { protected_.store(value, std::memory_order_seq_cst); }

 private:
  std::atomic<const T*> newest_{nullptr};
  std::atomic<const T*> in_use_{nullptr};
  std::atomic<const T*> protected_{nullptr};
  std::vector<std::shared_ptr<const T>> kept_; // writer only
};

} // namespace patina
