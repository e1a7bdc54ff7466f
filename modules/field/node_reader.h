// Many reads of a field's distances: a block is unpacked when it is first read.
#pragma once

#include <atomic>
#include <vector>

#include "field/surface_field.h"

namespace patina {

// A view: the field must outlive it. Holds 2 kB for each block that was read. Any thread, several
// at once, except the servo's: the first read of a block allocates.
class NodeReader {
 public:
  explicit NodeReader(const SurfaceField& field);
  ~NodeReader();
  NodeReader(const NodeReader&) = delete;
  NodeReader& operator=(const NodeReader&) = delete;

  const SurfaceField& field() const { return field_; }
  const DistanceNodes& block(std::size_t slot) const {
    const DistanceNodes* nodes = blocks_[slot].load(std::memory_order_acquire);
    return nodes ? *nodes : unpacked(slot);
  }
  // As SurfaceField::phiAt.
  float phiAt(int i, int j, int k) const;

 private:
  const DistanceNodes& unpacked(std::size_t slot) const;

  const SurfaceField& field_;
  mutable std::vector<std::atomic<const DistanceNodes*>> blocks_; // by slot; owned
};

} // namespace patina
