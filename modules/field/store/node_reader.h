// Fast repeated reads of a field's distances: a block is unpacked at its first read.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "field/store/surface_field.h"

namespace patina {

// View of a field, which must outlive it. Reserves 2 kB of addresses per block; the system
// allocates memory only for blocks that are read. Any threads, several at once, except the servo's:
// the first read of a block unpacks it while other readers of that block wait.
class NodeReader {
 public:
  explicit NodeReader(const SurfaceField& field);

  const SurfaceField& field() const { return field_; }
  const DistanceNodes& block(std::size_t slot) const {
    if (state_[slot].load(std::memory_order_acquire) != kRead) unpack(slot);
    return nodes_[slot];
  }
  // Returns +-kBackground outside the grid or in an unstored block.
  float phiAt(int i, int j, int k) const;

 private:
  enum State : std::uint8_t { kPacked, kBeingRead, kRead };
  void unpack(std::size_t slot) const;

  const SurfaceField& field_;
  std::unique_ptr<DistanceNodes[]> nodes_;               // per slot
  mutable std::vector<std::atomic<std::uint8_t>> state_; // per slot
};

} // namespace patina
