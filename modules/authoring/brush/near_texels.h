// Means over the neighbours that texels have on the surface, wherever charts end in the image.
#pragma once

#include <array>
#include <vector>

#include "core/types.h"

namespace patina {

struct NearTexel {
  Vec3 point = Vec3::Zero();  // [m]
  Vec3 normal = Vec3::Zero(); // of its face; zero without area
  double footprint = 0;       // [m], to its neighbours in the image
  bool inside = true;         // false: shows an edge once more, and counts for no other
  std::array<double, 4> values{};
};

// One for each: the mean over the others that lie within 1.5 footprints and face the same way; its
// own values where there is none. Found in space, so that seams are crossed and the far side of a
// thin wall is not. Order n log n for footprints that are alike.
std::vector<std::array<double, 4>> meansOfNeighbours(const std::vector<NearTexel>& texels);

} // namespace patina
