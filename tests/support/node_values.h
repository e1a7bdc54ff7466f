// The distance of one node, for tests: it unpacks a block, which is too slow for anything else.
#pragma once

#include "field/store/surface_field.h"

namespace patina::test {

// Returns +-kBackground outside the grid or in a block that is not stored.
inline float phiAt(const SurfaceField& field, int i, int j, int k) {
  const SurfaceField::NodeAddress place = field.placeOf(i, j, k);
  if (place.slot < 0) return backgroundOf(place.slot);
  return field.distance[static_cast<std::size_t>(place.slot)]->phi()[place.index];
}

} // namespace patina::test
