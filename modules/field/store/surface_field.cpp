#include "field/store/surface_field.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "field/build/sample_block.h"
#include "field/store/node_reader.h"

namespace patina {
namespace {

template <class Block>
std::size_t layerSize(const std::vector<std::shared_ptr<const Block>>& layer) {
  std::size_t sum = 0;
  for (const auto& block : layer) sum += sizeof(block) + block->bytes();
  return sum;
}

} // namespace

SurfaceField::Place SurfaceField::placeOf(int i, int j, int k) const {
  const auto& n = grid.nodes;
  if (i < 0 || j < 0 || k < 0 || i >= n[0] || j >= n[1] || k >= n[2]) return {kOutside, 0};
  const auto [block, node] = BlockNode::of(Index3{i, j, k});
  return {slotOf(block[0], block[1], block[2]), node};
}

std::int32_t SurfaceField::faceAt(int i, int j, int k) const {
  const Place place = placeOf(i, j, k);
  if (place.slot < 0 || face.empty()) return -1;
  return face[static_cast<std::size_t>(place.slot)]->at(place.index);
}

std::vector<LayerBytes> SurfaceField::layerBytes() const {
  std::vector<LayerBytes> layers;
  const auto add = [&](const char* name, std::size_t size) {
    if (size > 0) layers.push_back({name, size});
  };
  add("top", top.size() * sizeof(top[0]) + block_at.size() * sizeof(block_at[0]));
  add("distance", layerSize(distance));
  add("face", layerSize(face));
  add("sample", sample.size() * (sizeof(SampleBlock) + sizeof(sample[0])));
  add("coarse", coarse.size() * sizeof(CoarseNode));
  return layers;
}

std::size_t SurfaceField::bytes() const {
  std::size_t sum = 0;
  for (const LayerBytes& layer : layerBytes()) sum += layer.bytes;
  return sum;
}

std::shared_ptr<const SurfaceField> withSamples(std::shared_ptr<const SurfaceField> field) {
  if (field->sample.size() == field->blockCount()) return field;
  auto result = std::make_shared<SurfaceField>(*field);
  result->sample.resize(result->blockCount());
  const NodeReader nodes(*field);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result->blockCount(), 16),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t slot = range.begin(); slot < range.end(); ++slot)
                        result->sample[slot] = sampleBlock(nodes, slot);
                    });
  return result;
}

} // namespace patina
