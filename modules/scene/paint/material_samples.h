// Painted material as the servo reads it, by MaterialReader (K22, K23).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/paint/material_map.h"

namespace patina {

// Values as they are felt (paint over base), one block look-up a point: 9^3 nodes, those of a block
// and the first layer of its upper neighbours. Only channels that are painted somewhere.
struct MaterialSampleBlock; // material_samples.cpp
struct MaterialSamples {
  // Of one channel's nodes in one block.
  struct Extremes {
    std::array<double, kMaterialChannels> least{}, most{};
  };
  Vec3 origin = Vec3::Zero(); // [m], object frame
  double per_voxel = 0;       // [1/m]
  std::array<int, 3> first{}, blocks{};
  std::vector<std::int32_t> top; // slot, -1 = base everywhere
  std::vector<std::shared_ptr<const MaterialSampleBlock>> block;
  std::vector<const double*> nodes; // of each block
  std::vector<Extremes> extremes;   // by slot
  std::vector<MaterialMap::Index> block_at;
  std::array<bool, kMaterialChannels> painted{};
  std::size_t channels = 0; // that are painted
  Material base;
  Material least, most; // of each channel anywhere, base included
  std::size_t bytes() const;
};

// `before` (made from an earlier version of `map` with the same base) keeps blocks whose layers are
// the same; nullptr makes all. Null if nothing is painted.
std::shared_ptr<const MaterialSamples> materialSamples(const MaterialMap& map, const Material& base,
                                                       const MaterialMap* map_before,
                                                       const MaterialSamples* before);

} // namespace patina
