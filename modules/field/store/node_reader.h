// Many reads of a field's distances: a block is unpacked when it is first read.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "field/store/surface_field.h"

namespace patina {

// A view: the field must outlive it. Reserves 2 kB for each block of the field at once; the system
// takes memory only for those that are read. Any thread, several at once, except the servo's: the
// first read of a block unpacks it, and who reads it meanwhile waits.
class NodeReader {
 public:
  explicit NodeReader(const SurfaceField& field);

  const SurfaceField& field() const { return field_; }
  const DistanceNodes& block(std::size_t slot) const {
    if (state_[slot].load(std::memory_order_acquire) != kRead) unpack(slot);
    return nodes_[slot];
  }
  // Outside the grid or in a block that is not stored: +-kBeyondBand.
  float phiAt(int i, int j, int k) const;

 private:
  enum State : std::uint8_t { kPacked, kBeingRead, kRead };
  void unpack(std::size_t slot) const;

  const SurfaceField& field_;
  std::unique_ptr<DistanceNodes[]> nodes_;               // by slot
  mutable std::vector<std::atomic<std::uint8_t>> state_; // by slot
};

} // namespace patina
