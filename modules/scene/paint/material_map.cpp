#include "scene/paint/material_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace patina {
namespace {

bool isEmpty(const MaterialLayer& layer) {
  static const MaterialLayer kEmpty{};
  return std::memcmp(&layer, &kEmpty, sizeof layer) == 0;
}

bool sameLayer(const std::shared_ptr<MaterialLayer>& a, const std::shared_ptr<MaterialLayer>& b) {
  if (a == b) return true;
  if (!a || !b) return isEmpty(a ? *a : *b);
  return std::memcmp(a.get(), b.get(), sizeof *a) == 0;
}

bool covers(const MaterialMap& a, const MaterialMap& b) {
  static const MaterialBlock kNothing{};
  for (const auto& [index, block] : a.blocks()) {
    const auto other = b.blocks().find(index);
    const MaterialBlock& right = other == b.blocks().end() ? kNothing : other->second;
    for (std::size_t c = 0; c < kMaterialChannels; ++c)
      if (!sameLayer(block.layer[c], right.layer[c])) return false;
  }
  return true;
}

} // namespace

MaterialMap::MaterialMap(const Vec3& origin, double voxel) : origin_(origin), voxel_(voxel) {
  if (!origin.allFinite() || !(voxel > 0) || !std::isfinite(voxel))
    throw std::invalid_argument("MaterialMap: bad grid");
}

const MaterialLayer* MaterialMap::layer(const Index& block, MaterialChannel channel) const {
  const auto found = blocks_.find(block);
  if (found == blocks_.end()) return nullptr;
  return found->second.layer[static_cast<std::size_t>(channel)].get();
}

MaterialLayer& MaterialMap::writable(const Index& block, MaterialChannel channel) {
  std::shared_ptr<MaterialLayer>& layer = blocks_[block].layer[static_cast<std::size_t>(channel)];
  if (!layer)
    layer = std::make_shared<MaterialLayer>();
  else if (!own_.set.contains(layer.get()) || layer.use_count() > 1) // a plain copy also shares it
    layer = std::make_shared<MaterialLayer>(*layer);
  own_.set.insert(layer.get());
  return *layer;
}

MaterialMap MaterialMap::published() {
  own_.set.clear();
  return *this;
}

bool MaterialMap::has(MaterialChannel channel) const {
  return std::any_of(blocks_.begin(), blocks_.end(), [&](const auto& item) {
    return item.second.layer[static_cast<std::size_t>(channel)] != nullptr;
  });
}

void MaterialMap::dropEmptyLayers() {
  for (auto item = blocks_.begin(); item != blocks_.end();) {
    bool any = false;
    for (std::shared_ptr<MaterialLayer>& layer : item->second.layer) {
      if (layer && isEmpty(*layer)) {
        own_.set.erase(layer.get());
        layer.reset();
      }
      any = any || layer;
    }
    item = any ? std::next(item) : blocks_.erase(item);
  }
}

std::size_t MaterialMap::bytes() const {
  // A tree node has three pointers and a colour beside its value.
  std::size_t bytes = sizeof *this;
  for (const auto& [index, block] : blocks_) {
    bytes += sizeof(index) + sizeof(block) + 4 * sizeof(void*);
    for (const auto& layer : block.layer)
      if (layer) bytes += sizeof(MaterialLayer);
  }
  return bytes;
}

// Calls visit(block, node, share) for the corners of p's cell in painted blocks.
template <typename Visit> void MaterialMap::forCorners(const Vec3& p, const Visit& visit) const {
  const Vec3 q = (p - origin_) / voxel_;
  if (!q.allFinite() || q.cwiseAbs().maxCoeff() > 1e9) return;
  const Vec3 low = q.array().floor();
  const Vec3 part = q - low;
  for (int corner = 0; corner < 8; ++corner) {
    std::array<std::int64_t, 3> node{};
    double share = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const bool high = corner >> axis & 1;
      node[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(low[axis]) + high;
      share *= high ? part[axis] : 1 - part[axis];
    }
    const BlockNode at = BlockNode::of(node);
    const auto block = blocks_.find(at.block);
    if (block != blocks_.end() && share != 0) visit(block->second, at.node, share);
  }
}

double compositedAt(const MaterialLayer& layer, std::size_t node, double own,
                    const MaterialRange& range) {
  const auto value = static_cast<double>(layer.value[node]);
  const auto weight = static_cast<double>(layer.weight[node]);
  // Unpainted values stay equal to the base bit for bit.
  if (value == 0 && weight == 0) return own;
  return std::clamp(value + (1 - weight) * own, range.min, range.max);
}

Material MaterialMap::at(const Vec3& p, const Material& base) const {
  std::array<double, kMaterialChannels> change{};
  forCorners(p, [&](const MaterialBlock& block, std::size_t node, double share) {
    for (const MaterialChannel channel : kAllMaterialChannels) {
      const auto c = static_cast<std::size_t>(channel);
      const double own = valueOf(base, channel);
      if (const MaterialLayer* layer = block.layer[c].get())
        change[c] += share * (compositedAt(*layer, node, own, rangeOf(channel)) - own);
    }
  });
  Material result = base;
  for (const MaterialChannel channel : kAllMaterialChannels)
    valueOf(result, channel) += change[static_cast<std::size_t>(channel)];
  return result;
}

MaterialMap::Paint MaterialMap::paintAt(const Vec3& p, MaterialChannel channel) const {
  Paint paint;
  forCorners(p, [&](const MaterialBlock& block, std::size_t node, double share) {
    const MaterialLayer* layer = block.layer[static_cast<std::size_t>(channel)].get();
    if (!layer) return;
    paint.value += share * static_cast<double>(layer->value[node]);
    paint.weight += share * static_cast<double>(layer->weight[node]);
  });
  return paint;
}

bool same(const MaterialMap& a, const MaterialMap& b) {
  return a.origin() == b.origin() && a.voxel() == b.voxel() && covers(a, b) && covers(b, a);
}

} // namespace patina
