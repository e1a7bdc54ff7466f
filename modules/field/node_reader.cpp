#include "field/node_reader.h"

#include <memory>

namespace patina {

NodeReader::NodeReader(const SurfaceField& field) : field_(field), blocks_(field.blockCount()) {}

NodeReader::~NodeReader() {
  for (auto& block : blocks_) delete block.load(std::memory_order_relaxed);
}

const DistanceNodes& NodeReader::unpacked(std::size_t slot) const {
  auto nodes = std::make_unique_for_overwrite<DistanceNodes>();
  field_.distance[slot]->unpack(*nodes);
  const DistanceNodes* held = nullptr; // what another thread was first with
  if (blocks_[slot].compare_exchange_strong(held, nodes.get(), std::memory_order_acq_rel))
    held = nodes.release();
  return *held;
}

float NodeReader::phiAt(int i, int j, int k) const {
  const SurfaceField::Place place = field_.placeOf(i, j, k);
  return place.slot < 0 ? phiBeyond(place.slot)
                        : block(static_cast<std::size_t>(place.slot)).phi[place.index];
}

} // namespace patina
