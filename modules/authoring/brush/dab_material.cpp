#include "authoring/brush/dab_material.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

constexpr double kNothing = 1e-6; // a weight that the eraser may round away

MaterialMap mapOr(const std::shared_ptr<const MaterialMap>& map, const PaintSurface& surface,
                  const Pose& world_from_object) {
  if (map) return *map;
  const FieldGrid& grid = surface.field->grid;
  return MaterialMap(world_from_object.inverse() * grid.origin, grid.voxel);
}

double held(double value, const MaterialRange& range) {
  return std::clamp(value, range.least, range.most);
}

} // namespace

MaterialStroke::MaterialStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
                               std::shared_ptr<const MaterialMap> start, const Material& base,
                               std::vector<MaterialInk> inks)
    : surface_(std::move(surface)), world_from_object_(surface_->objects[object].world_from_object),
      start_(mapOr(start, *surface_, world_from_object_)), map_(start_), base_(base),
      inks_(std::move(inks)) {}

std::size_t MaterialStroke::paint(const Dab& dab, const Brush& brush) {
  const Dab local = dab.in(world_from_object_.inverse()); // but its front
  if (brush.mode == StrokeMode::smooth && brush.tool != Tool::erase) return smooth(local, brush);
  return lay(local, brush);
}

template <typename Visit>
void MaterialStroke::forBlocks(const Dab& local, const Visit& visit) const {
  const Vec3 reach = Vec3::Constant(local.reach());
  const Vec3 low = (local.centre() - reach - map_.origin()) / (map_.voxel() * kMaterialSide);
  const Vec3 high = (local.centre() + reach - map_.origin()) / (map_.voxel() * kMaterialSide);
  const auto block = [](double x) { return static_cast<std::int32_t>(std::floor(x)); };
  for (std::int32_t z = block(low[2]); z <= block(high[2]); ++z)
    for (std::int32_t y = block(low[1]); y <= block(high[1]); ++y)
      for (std::int32_t x = block(low[0]); x <= block(high[0]); ++x) visit(Index{x, y, z});
}

// Calls visit(node, weight).
template <typename Visit>
void MaterialStroke::forNodes(const Dab& local, const Brush& brush, const Index& block,
                              const Visit& visit) const {
  for (std::size_t node = 0; node < kMaterialNodes; ++node) {
    const Vec3 place = placeOf(block, node);
    const double weight = weightAt(local, brush, place);
    if (weight > 0 && !looksAway(place, local.front)) visit(node, weight);
  }
}

Vec3 MaterialStroke::placeOf(const Index& block, std::size_t node) const {
  const Index3 at = BlockNode{block, node}.at();
  return map_.origin() + map_.voxel() * Vec3(at[0], at[1], at[2]);
}

// No contact reads a node beyond the band.
bool MaterialStroke::isNearSurface(const Index& block) const {
  const SurfaceField& field = *surface_->field;
  Box3 box;
  for (int corner = 0; corner < 8; ++corner)
    box.extend(world_from_object_ *
               placeOf(block, static_cast<std::size_t>((corner & 1) * 7 + (corner >> 1 & 1) * 56 +
                                                       (corner >> 2) * 448)));
  std::array<int, 3> low{}, high{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double side = field.grid.voxel * kBlockSide, last = field.blocks[a] - 1;
    const double slack = 1e-6; // of rounding: a block is not near for touching its neighbour
    const double from = (box.min()[axis] - field.grid.origin[axis]) / side + slack;
    const double to = (box.max()[axis] - field.grid.origin[axis]) / side - slack;
    if (!(to >= 0 && from < last + 1)) return false;
    low[a] = static_cast<int>(std::clamp(std::floor(from), 0.0, last));
    high[a] = static_cast<int>(std::clamp(std::floor(to), 0.0, last));
  }
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x)
        if (field.slotOf(x, y, z) >= 0) return true;
  return false;
}

bool MaterialStroke::looksAway(const Vec3& place, const Vec3& front) const {
  if (front.isZero(0)) return false;
  const SurfaceField& field = *surface_->field;
  const Vec3 q = field.grid.toGrid(world_from_object_ * place);
  const auto nearest = [&](int axis) { return static_cast<int>(std::lround(q[axis])); };
  const std::int32_t face = field.faceAt(nearest(0), nearest(1), nearest(2));
  return face >= 0 && faceNormal(*surface_->mesh, static_cast<std::size_t>(face)).dot(front) <= 0;
}

std::size_t MaterialStroke::lay(const Dab& local, const Brush& brush) {
  const bool erases = brush.tool == Tool::erase;
  const bool builds_up = brush.mode == StrokeMode::build_up;
  std::size_t count = 0;
  forBlocks(local, [&](const Index& block) {
    if (erases ? !map_.blocks().contains(block) : !isNearSurface(block)) return;
    Weights* greatest = nullptr;
    forNodes(local, brush, block, [&](std::size_t node, double weight) {
      ++count;
      if (!builds_up) {
        if (!greatest) greatest = &weights_[block];
        float& before = (*greatest)[node];
        if (weight <= static_cast<double>(before)) return;
        before = static_cast<float>(weight);
      }
      for (const auto& [channel, value] : inks_) {
        const MaterialLayer* under = (builds_up ? map_ : start_).layer(block, channel);
        if (erases && !under) continue;
        Pair pair;
        if (under)
          pair = {static_cast<double>(under->value[node]),
                  static_cast<double>(under->weight[node])};
        if (brush.mode == StrokeMode::add && !erases) {
          const double ground = (1 - pair.weight) * valueOf(base_, channel);
          pair.value = held(ground + pair.value + weight * value, rangeOf(channel)) - ground;
        } else {
          pair.value = (1 - weight) * pair.value + (erases ? 0 : weight * value);
          pair.weight = (1 - weight) * pair.weight + (erases ? 0 : weight);
          const bool nothing = pair.weight < kNothing && std::abs(pair.value) < kNothing;
          if (erases && nothing) pair = {};
        }
        set(block, node, channel, pair);
      }
    });
  });
  return count;
}

std::size_t MaterialStroke::smooth(const Dab& local, const Brush& brush) {
  struct Place {
    Index block;
    std::size_t node;
    MaterialChannel channel;
    Pair pair;
  };
  std::vector<Place> places; // written at the end: every mean is of the values before the dab
  std::size_t count = 0;
  forBlocks(local, [&](const Index& block) {
    if (!isNearSurface(block)) return;
    forNodes(local, brush, block, [&](std::size_t node, double weight) {
      ++count;
      const Index3 at = BlockNode{block, node}.at();
      for (const MaterialInk& ink : inks_) {
        const MaterialChannel channel = ink.channel;
        Pair mean;
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (const int step : {-1, 1}) {
            Index3 beside = at;
            beside[axis] += step;
            const Pair pair = pairAt(beside, channel);
            mean.value += pair.value / 6;
            mean.weight += pair.weight / 6;
          }
        Pair pair = pairAt(at, channel);
        pair.value += weight * (mean.value - pair.value);
        pair.weight += weight * (mean.weight - pair.weight);
        places.push_back({block, node, channel, pair});
      }
    });
  });
  for (const Place& place : places) set(place.block, place.node, place.channel, place.pair);
  return count;
}

MaterialStroke::Pair MaterialStroke::pairAt(const std::array<std::int32_t, 3>& node,
                                            MaterialChannel channel) const {
  const auto [block, n] = BlockNode::of(node);
  const MaterialLayer* layer = map_.layer(block, channel);
  if (!layer) return {};
  return {static_cast<double>(layer->value[n]), static_cast<double>(layer->weight[n])};
}

void MaterialStroke::set(const Index& block, std::size_t node, MaterialChannel channel,
                         const Pair& pair) {
  const auto value = static_cast<float>(pair.value), weight = static_cast<float>(pair.weight);
  const MaterialLayer* before = map_.layer(block, channel);
  // A layer stays shared, or absent, until something in it becomes other than it was.
  if ((before ? before->value[node] : 0.0f) == value &&
      (before ? before->weight[node] : 0.0f) == weight)
    return;
  MaterialLayer& layer = map_.writable(block, channel);
  layer.value[node] = value;
  layer.weight[node] = weight;
  changed_ = true;
  written_.insert(block);
  region_.extend(world_from_object_ * placeOf(block, node));
}

std::shared_ptr<const MaterialMap> MaterialStroke::take() {
  changed_ = false;
  if (map_.blocks().empty()) return nullptr;
  return std::make_shared<const MaterialMap>(map_.published());
}

void MaterialStroke::dropEmpty() {
  map_.dropEmptyLayers();
  changed_ = true;
}

std::vector<MaterialMap::Index> MaterialStroke::takeBlocks() {
  std::vector<Index> blocks(written_.begin(), written_.end());
  written_.clear();
  return blocks;
}

Box3 MaterialStroke::takeRegion() {
  const Box3 region = region_;
  region_.setEmpty();
  return region;
}

} // namespace patina
