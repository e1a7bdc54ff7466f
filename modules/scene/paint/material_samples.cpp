#include "scene/paint/material_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace patina {

namespace {

constexpr int kSide = kMaterialSide + 1;
constexpr std::size_t kNodes = static_cast<std::size_t>(kSide) * kSide * kSide;

} // namespace

// Node by node, x fastest, each with its painted channels in order. Doubles keep the base bit for
// bit where paint does not cover it and reproduce affine fields (T-K22a).
struct MaterialSampleBlock {
  std::vector<double> values;
};

namespace {

using Index = MaterialMap::Index;
using Painted = std::array<bool, kMaterialChannels>;

// Dense table over a box of blocks.
template <class T> struct Table {
  std::array<int, 3> first{}, count{};
  std::vector<T> cells;

  bool find(const Index& b, std::size_t& cell) const {
    std::array<std::size_t, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t i = std::int64_t{b[a]} - first[a];
      if (i < 0 || i >= count[a]) return false;
      at[a] = static_cast<std::size_t>(i);
    }
    cell =
        (at[2] * static_cast<std::size_t>(count[1]) + at[1]) * static_cast<std::size_t>(count[0]) +
        at[0];
    return true;
  }
};

// Visits the blocks of samples that read a block of the map: itself and its seven lower neighbours.
template <class Visit> void readersOf(const Index& b, const Visit& visit) {
  for (int corner = 0; corner < 8; ++corner)
    visit(Index{b[0] - (corner & 1), b[1] - (corner >> 1 & 1), b[2] - (corner >> 2)});
}

Table<char> tableAround(const MaterialMap& map) {
  Table<char> table;
  Index low{}, high{};
  bool any = false;
  for (const auto& [index, block] : map.blocks()) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = any ? std::min(low[a], index[a]) : index[a];
      high[a] = any ? std::max(high[a], index[a]) : index[a];
    }
    any = true;
  }
  std::size_t cells = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    table.first[a] = low[a] - 1;
    table.count[a] = high[a] - low[a] + 2;
    cells *= static_cast<std::size_t>(table.count[a]);
  }
  table.cells.assign(any ? cells : 0, 0);
  return table;
}

enum : char { kNothing = 0, kKept = 1, kMade = 2, kLost = 4 };

// Marks the needed samples and those to compute again. Both maps have the same order.
void mark(const MaterialMap& map, const MaterialMap* before, Table<char>& table) {
  const auto raise = [&](const Index& index, char to) {
    readersOf(index, [&](const Index& reader) {
      std::size_t cell = 0;
      if (!table.find(reader, cell)) return;
      char& mark = table.cells[cell];
      mark = static_cast<char>((mark & kLost) | std::max<char>(mark & ~kLost, to));
    });
  };
  static const std::map<Index, MaterialBlock> kNone;
  const auto& now = map.blocks();
  const auto& was = before ? before->blocks() : kNone;
  auto n = now.begin();
  auto w = was.begin();
  while (n != now.end() || w != was.end()) {
    const bool gone = n == now.end() || (w != was.end() && w->first < n->first);
    const bool fresh = !gone && (w == was.end() || n->first < w->first);
    if (gone) {
      // Sample blocks that read a removed block have changed.
      readersOf(w->first, [&](const Index& reader) {
        std::size_t cell = 0;
        if (table.find(reader, cell)) table.cells[cell] |= kLost;
      });
      ++w;
      continue;
    }
    raise(n->first, fresh || n->second.layer != w->second.layer ? kMade : kKept);
    if (!fresh) ++w;
    ++n;
  }
  for (char& cell : table.cells)
    if (cell & kLost) cell = cell & ~kLost ? kMade : kNothing;
}

Painted paintedIn(const MaterialMap& map) {
  Painted painted{};
  for (const auto& [index, block] : map.blocks())
    for (std::size_t c = 0; c < kMaterialChannels; ++c) painted[c] |= block.layer[c] != nullptr;
  return painted;
}

std::size_t countOf(const Painted& painted) {
  return static_cast<std::size_t>(std::count(painted.begin(), painted.end(), true));
}

std::shared_ptr<const MaterialSampleBlock> made(const MaterialMap& map, const Index& at,
                                                const Painted& painted, const Material& base,
                                                MaterialSamples::Extremes& extremes) {
  std::array<const MaterialBlock*, 8> source{};
  for (int corner = 0; corner < 8; ++corner) {
    const auto found =
        map.blocks().find({at[0] + (corner & 1), at[1] + (corner >> 1 & 1), at[2] + (corner >> 2)});
    if (found != map.blocks().end()) source[static_cast<std::size_t>(corner)] = &found->second;
  }
  auto block = std::make_shared<MaterialSampleBlock>();
  const std::size_t channels = countOf(painted);
  block->values.resize(kNodes * channels);
  std::size_t slot = 0;
  for (std::size_t c = 0; c < kMaterialChannels; ++c) {
    const double own = valueOf(base, kAllMaterialChannels[c]);
    const MaterialRange range = rangeOf(kAllMaterialChannels[c]);
    extremes.min[c] = extremes.max[c] = own;
    if (!painted[c]) continue;
    double* value = block->values.data() + slot++;
    for (int z = 0; z < kSide; ++z)
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x, value += channels) {
          const auto [in, node] = BlockNode::of(Index3{x, y, z});
          const int corner = in[0] + 2 * in[1] + 4 * in[2];
          const MaterialBlock* from = source[static_cast<std::size_t>(corner)];
          const MaterialLayer* layer = from ? from->layer[c].get() : nullptr;
          *value = own;
          if (!layer) continue;
          *value = compositedAt(*layer, node, own, range);
          extremes.min[c] = std::min(extremes.min[c], *value);
          extremes.max[c] = std::max(extremes.max[c], *value);
        }
  }
  return block;
}

} // namespace

std::size_t MaterialSamples::bytes() const {
  return sizeof *this + block_index.size() * sizeof(block_index[0]) +
         block.size() * (sizeof(block[0]) + sizeof(nodes[0]) + sizeof(Extremes) + sizeof(Index) +
                         sizeof(MaterialSampleBlock) + kNodes * channels * sizeof(double));
}

std::shared_ptr<const MaterialSamples> materialSamples(const MaterialMap& map, const Material& base,
                                                       const MaterialMap* map_before,
                                                       const MaterialSamples* before) {
  const Painted painted = paintedIn(map);
  if (countOf(painted) == 0) return nullptr;
  const bool keeps = before && map_before && before->painted == painted && before->base == base &&
                     map_before->origin() == map.origin() && map_before->voxel() == map.voxel();
  Table<char> table = tableAround(map);
  if (table.cells.size() > std::numeric_limits<std::int32_t>::max())
    throw std::length_error("materialSamples: paint lies too far apart");
  mark(map, keeps ? map_before : nullptr, table);

  auto samples = std::make_shared<MaterialSamples>();
  samples->origin = map.origin();
  samples->per_voxel = 1 / map.voxel();
  samples->first = table.first;
  samples->blocks = table.count;
  samples->painted = painted;
  samples->channels = countOf(painted);
  samples->base = samples->min = samples->max = base;
  samples->block_index.assign(table.cells.size(), -1);
  Table<char> old;
  if (keeps) old = {before->first, before->blocks, {}};
  std::size_t cell = 0;
  for (int z = 0; z < table.count[2]; ++z)
    for (int y = 0; y < table.count[1]; ++y)
      for (int x = 0; x < table.count[0]; ++x, ++cell) {
        if (table.cells[cell] == kNothing) continue;
        const Index at{x + table.first[0], y + table.first[1], z + table.first[2]};
        samples->block_index[cell] = static_cast<std::int32_t>(samples->block.size());
        samples->block_at.push_back(at);
        std::size_t was = 0;
        const std::int32_t slot = keeps && table.cells[cell] == kKept && old.find(at, was)
                                      ? before->block_index[was]
                                      : -1;
        if (slot >= 0) {
          const auto kept = static_cast<std::size_t>(slot);
          samples->block.push_back(before->block[kept]);
          samples->extremes.push_back(before->extremes[kept]);
        } else {
          samples->extremes.emplace_back();
          samples->block.push_back(made(map, at, painted, base, samples->extremes.back()));
        }
      }
  for (const auto& block : samples->block) samples->nodes.push_back(block->values.data());
  for (const MaterialSamples::Extremes& extremes : samples->extremes)
    for (const MaterialChannel channel : kAllMaterialChannels) {
      const auto c = static_cast<std::size_t>(channel);
      double& least = valueOf(samples->min, channel);
      double& most = valueOf(samples->max, channel);
      least = std::min(least, extremes.min[c]);
      most = std::max(most, extremes.max[c]);
    }
  return samples;
}

} // namespace patina
