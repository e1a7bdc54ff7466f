#include "field/store/node_reader.h"

namespace patina {

NodeReader::NodeReader(const SurfaceField& field)
    : field_(field), nodes_(std::make_unique_for_overwrite<DistanceNodes[]>(field.blockCount())),
      state_(field.blockCount()) {}

void NodeReader::unpack(std::size_t slot) const {
  std::uint8_t state = kPacked;
  if (state_[slot].compare_exchange_strong(state, kBeingRead, std::memory_order_acquire)) {
    field_.distance[slot]->unpack(nodes_[slot]);
    state_[slot].store(kRead, std::memory_order_release);
    state_[slot].notify_all();
  } else {
    state_[slot].wait(kBeingRead, std::memory_order_acquire);
  }
}

float NodeReader::phiAt(int i, int j, int k) const {
  const SurfaceField::NodeAddress place = field_.placeOf(i, j, k);
  return place.slot < 0 ? backgroundOf(place.slot)
                        : block(static_cast<std::size_t>(place.slot)).phi[place.index];
}

} // namespace patina
