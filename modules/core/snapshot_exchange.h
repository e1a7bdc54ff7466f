// One immutable value handed from a writer thread to one real-time reader.
//
// The reader never locks, allocates or frees; it acknowledges the value that it uses, and the
// writer frees what no acknowledged reader can still see. Not std::atomic<std::shared_ptr>:
// that is not lock-free in g++ 12.
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

  // Writer thread. The value is visible to the next latest(). Frees values that the reader left.
  void publish(std::shared_ptr<const T> value) {
    const T* raw = value.get();
    kept_.push_back(std::move(value));
    newest_.store(raw, std::memory_order_seq_cst);
    collect();
  }

  // Writer thread. Frees retired values that the reader no longer uses; returns how many are alive.
  std::size_t collect() {
    // In this order: a value that the reader moves from in_use_ to held_ is seen in one of them.
    const T* in_use = in_use_.load(std::memory_order_seq_cst);
    const T* held = held_.load(std::memory_order_seq_cst);
    const T* newest = newest_.load(std::memory_order_relaxed);
    std::erase_if(kept_, [&](const auto& item) {
      return item.get() != in_use && item.get() != held && item.get() != newest;
    });
    return kept_.size();
  }

  // Reader thread, wait-free in practice: the newest value, or nullptr before the first. It stays
  // valid until this thread's next call, or longer if hold() is called with it before that.
  const T* latest() noexcept {
    const T* seen = newest_.load(std::memory_order_seq_cst);
    for (;;) {
      in_use_.store(seen, std::memory_order_seq_cst);
      // The writer may have replaced and collected `seen` before our mark was visible: look again.
      const T* again = newest_.load(std::memory_order_seq_cst);
      if (again == seen) return seen;
      seen = again;
    }
  }

  // Reader thread, wait-free: keeps one value that latest() returned last, or that is held already,
  // valid until the next hold(). nullptr holds nothing.
  void hold(const T* value) noexcept { held_.store(value, std::memory_order_seq_cst); }

 private:
  std::atomic<const T*> newest_{nullptr};
  std::atomic<const T*> in_use_{nullptr};
  std::atomic<const T*> held_{nullptr};
  std::vector<std::shared_ptr<const T>> kept_; // writer's own
};

} // namespace patina
