// A field's nodes laid out again for the study's candidates.
#pragma once

#include <array>
#include <vector>

#include "field/store/surface_field.h"

namespace patina {

struct DenseNodes {
  std::array<int, 3> size{}; // whole blocks; x fastest
  std::vector<float> phi;    // voxels, +-kBeyondBand where not stored

  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size[1]) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(i);
  }
};

DenseNodes denseNodes(const SurfaceField& field);

// For each slot the side^3 nodes that begin `first` (0 or negative) from the block's own first;
// +kBeyondBand past the ends.
std::vector<float> gatherBlocks(const SurfaceField& field, const DenseNodes& nodes, int first,
                                int side);

} // namespace patina
