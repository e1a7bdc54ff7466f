#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "field/store/surface_field.h"

namespace patina {
namespace {

using Function = std::function<double(const Vec3&)>;

std::array<int, 3> blockCoordinates(std::size_t index, const std::array<int, 3>& blocks) {
  const auto nx = static_cast<std::size_t>(blocks[0]), ny = static_cast<std::size_t>(blocks[1]);
  return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
          static_cast<int>(index / (nx * ny))};
}

// Returns null if no node is in the band, and the block's side in `top`.
std::shared_ptr<const DistanceBlock> sampleBlock(const Function& phi, const SurfaceField& field,
                                                 const std::array<int, 3>& at, std::int32_t& top) {
  const FieldGrid& grid = field.grid;
  const Vec3 corner = kBlockSide * Vec3(at[0], at[1], at[2]);
  const Vec3 half = Vec3::Constant(0.5 * (kBlockSide - 1));
  const double centre = phi(grid.toWorld(corner + half)) / grid.voxel;
  top = centre < 0 ? SurfaceField::kInside : SurfaceField::kOutside;
  if (std::abs(centre) > (field.band + half.norm()) * (1 + 1e-12)) return nullptr;

  DistanceNodes nodes;
  bool any = false;
  float* out = nodes.phi.data();
  for (int z = 0; z < kBlockSide; ++z)
    for (int y = 0; y < kBlockSide; ++y)
      for (int x = 0; x < kBlockSide; ++x, ++out) {
        // Includes nodes beyond the grid's last one, so that gradients beside it stay central.
        const double value = phi(grid.toWorld(corner + Vec3(x, y, z))) / grid.voxel;
        const bool stored = std::abs(value) <= field.band;
        *out = stored ? static_cast<float>(value) : value < 0 ? -kBackground : kBackground;
        any |= stored;
      }
  return any ? std::make_shared<const DistanceBlock>(nodes) : nullptr;
}

CoarseNode coarseNode(const Function& phi, const FieldGrid& grid, const Vec3& q) {
  const auto at = [&](const Vec3& node) { return phi(grid.toWorld(node)) / grid.voxel; };
  CoarseNode node{static_cast<float>(at(q)), 0, 0, 0};
  float* gradient[] = {&node.gx, &node.gy, &node.gz};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = Vec3::Unit(axis);
    *gradient[axis] = static_cast<float>(0.5 * (at(q + step) - at(q - step)));
  }
  return node;
}

template <class Body> void parallelFor(std::size_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 8),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
                    });
}

} // namespace

SurfaceField sampleFunction(const Function& phi, const FieldGrid& grid, double band) {
  SurfaceField field;
  field.grid = grid;
  field.band = band;
  std::size_t block_total = 1, corner_total = 1;
  std::array<int, 3> corners{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    field.blocks[axis] = (grid.nodes[axis] + kBlockSide - 1) / kBlockSide;
    corners[axis] = field.blocks[axis] + 1;
    block_total *= static_cast<std::size_t>(field.blocks[axis]);
    corner_total *= static_cast<std::size_t>(corners[axis]);
  }

  field.block_index.resize(block_total);
  std::vector<std::shared_ptr<const DistanceBlock>> sampled(block_total);
  parallelFor(block_total, [&](std::size_t index) {
    sampled[index] =
        sampleBlock(phi, field, blockCoordinates(index, field.blocks), field.block_index[index]);
  });
  for (std::size_t index = 0; index < block_total; ++index) {
    if (!sampled[index]) continue;
    field.block_index[index] = static_cast<std::int32_t>(field.distance.size());
    field.block_at.push_back(blockCoordinates(index, field.blocks));
    field.distance.push_back(std::move(sampled[index]));
  }

  field.coarse.resize(corner_total);
  parallelFor(corner_total, [&](std::size_t index) {
    const auto at = blockCoordinates(index, corners);
    field.coarse[index] = coarseNode(phi, grid, kBlockSide * Vec3(at[0], at[1], at[2]));
  });
  return field;
}

} // namespace patina
