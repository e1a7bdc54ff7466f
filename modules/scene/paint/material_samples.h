// Samples of painted material for MaterialReader in the servo (K22, K23).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/paint/material_map.h"

namespace patina {

// Composited values with one block look-up per point: 9^3 nodes, those of a block and the first
// layer of its upper neighbours. Painted channels only.
struct MaterialSampleBlock; // material_samples.cpp
struct MaterialSamples {
  // Range of one channel's nodes in one block.
  struct Extremes {
    std::array<double, kMaterialChannels> min{}, max{};
  };
  Vec3 origin = Vec3::Zero(); // [m], object frame
  double per_voxel = 0;       // [1/m]
  std::array<int, 3> first{}, blocks{};
  std::vector<std::int32_t> block_index; // slot, -1 = base everywhere
  std::vector<std::shared_ptr<const MaterialSampleBlock>> block;
  std::vector<const double*> nodes; // first value of each block
  std::vector<Extremes> extremes;   // per slot
  std::vector<MaterialMap::Index> block_at;
  std::array<bool, kMaterialChannels> painted{};
  std::size_t channels = 0; // number of painted channels
  Material base;
  Material min, max; // range of each channel, base included
  std::size_t bytes() const;
};

// Makes the samples of `map`. `before` (from an earlier version of it with the same base) provides
// the blocks whose layers are unchanged; nullptr: none. Returns null if nothing is painted.
std::shared_ptr<const MaterialSamples> materialSamples(const MaterialMap& map, const Material& base,
                                                       const MaterialMap* map_before,
                                                       const MaterialSamples* before);

} // namespace patina
