#include "authoring/relief/relief_bake.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "authoring/relief/relief_image.h"
#include "authoring/relief/relief_lookup.h"
#include "core/error.h"
#include "core/numbers.h"
#include "field/construction/edit_field.h"

namespace patina {
namespace {

TileRange rangeOf(const TiledImage::Tile& tile) {
  TileRange range;
  float poison = 0; // becomes NaN if a value is NaN or infinite
  for (const float value : tile) {
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
    poison += 0 * value;
  }
  range.finite = poison == 0;
  return range;
}

} // namespace

ImageRange imageRange(const TiledImage& image, const TiledImage* before, const ImageRange* known) {
  ImageRange result;
  if (before && known && before->tileCount() == image.tileCount()) result.tiles = known->tiles;
  const bool knows = !result.tiles.empty();
  result.tiles.resize(image.tileCount());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, image.tileCount(), 512),
                    [&](const tbb::blocked_range<std::size_t>& tiles) {
                      for (std::size_t i = tiles.begin(); i < tiles.end(); ++i) {
                        const auto& tile = image.sharedTile(i);
                        if (knows && tile == before->sharedTile(i)) continue;
                        result.tiles[i] = tile ? rangeOf(*tile) : TileRange{};
                      }
                    });
  for (const TileRange& tile : result.tiles) {
    result.all.low = std::min(result.all.low, tile.low);
    result.all.high = std::max(result.all.high, tile.high);
    result.all.finite = result.all.finite && tile.finite;
  }
  return result;
}

namespace {

std::vector<ReliefImage> imagesOf(std::span<const ReliefInput> sources, double voxel) {
  std::vector<ReliefImage> images;
  images.reserve(sources.size());
  for (const ReliefInput& source : sources) images.emplace_back(source, voxel);
  return images;
}

bool same(const DistanceNodes& a, const DistanceNodes& b) {
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}

bool meet(const BlockLookups& feet, const UvBox& box) {
  return feet.low[0] <= box.high[0] && feet.high[0] >= box.low[0] && feet.low[1] <= box.high[1] &&
         feet.high[1] >= box.low[1];
}

void checkSources(std::span<const ReliefInput> sources, const TriangleMesh& mesh) {
  for (const ReliefInput& source : sources)
    if (source.uvs &&
        (source.first_face < 0 || source.faces < 0 ||
         source.uvs->size() != static_cast<std::size_t>(source.faces) ||
         static_cast<std::size_t>(source.first_face) + source.uvs->size() > mesh.triangles.size()))
      throw std::invalid_argument("ReliefBake: the sources do not fit the mesh");
}

} // namespace

struct ReliefBake::Impl {
  std::shared_ptr<const SurfaceField> base; // with samples
  std::vector<ReliefInput> layout;          // without images
  ReliefLookups feet;
  std::vector<std::int32_t> slots; // slots with relief

  double voxel() const { return base->grid.voxel; }

  void check(std::span<const ReliefInput> sources) const {
    bool fits = sources.size() == layout.size();
    for (std::size_t i = 0; fits && i < layout.size(); ++i)
      fits = sources[i].first_face == layout[i].first_face && sources[i].uvs == layout[i].uvs &&
             (!sources[i].image || (sources[i].uvs && sources[i].image->channels() == 1));
    if (!fits) throw std::invalid_argument("ReliefBake: not the sources that it was made for");
  }

  // A sheet is as thick as the band; its farther half belongs to its back, which does not move.
  void checkPlate(double engraved) const {
    const double most = std::max(base->band / 2 - kSheetMargin, 0.0) * voxel();
    if (engraved > most)
      throw Error("relief: an open surface is a plate as thick as its band, of " +
                  formatNumber(base->band) + " voxels: it can be engraved by " +
                  formatLength(most) + ", not by " + formatLength(engraved) + "; set band to " +
                  formatNumber(std::ceil(2 * (engraved / voxel() + kSheetMargin))) +
                  " or lower relief.height");
  }

  ReliefRange rangeThatFits(std::span<const ReliefInput> sources) const {
    const ReliefRange range = reliefRange(sources);
    const double highest = std::max(range.high, -range.low);
    if (highest > 0 && base->band - highest / voxel() < kBandMargin)
      throw Error("relief: " + formatLength(highest) + " is more than the " +
                  formatLength(std::max(base->band - kBandMargin, 0.0) * voxel()) +
                  " that a band of " + formatNumber(base->band) + " voxels holds; set band to " +
                  formatNumber(std::ceil(highest / voxel() + kBandMargin)) +
                  " or lower relief.height");
    for (std::size_t i = 0; i < sources.size(); ++i)
      if (feet.plates[i]) checkPlate(-reliefRange(sources.subspan(i, 1)).low);
    return range;
  }

  // Moves distances of the base in place. Returns false if none changed.
  bool move(std::size_t slot, const std::vector<ReliefImage>& images, DistanceNodes& nodes) const {
    const BlockLookups& block = feet.block[slot];
    std::array<float, kBlockNodes>& phi = nodes.phi;
    const NodeUv* uv = feet.uv.data() + block.first;
    bool moves = false;
    const auto each = [&](const auto& image_of) {
      std::size_t entry = 0;
      for (std::size_t n = 0; n < kBlockNodes; ++n) {
        if (!(std::abs(phi[n]) < kBackground)) continue;
        const ReliefImage* image = image_of(entry);
        const float fall = image && uv[entry] != kNoLookup ? image->at(uv[entry]) : 0.0F;
        ++entry;
        if (fall == 0) continue; // -0 minus -0 would lose the sign
        const float moved = phi[n] - fall;
        moves |= moved != phi[n];
        phi[n] = moved;
      }
    };
    const auto felt = [&](std::int32_t source) -> const ReliefImage* {
      if (source == BlockLookups::kNone) return nullptr;
      const ReliefImage& image = images[static_cast<std::size_t>(source)];
      return image.isFlat() ? nullptr : &image;
    };
    if (block.source == BlockLookups::kMixed) {
      const std::int32_t* source = feet.source.data() + block.first_source;
      each([&](std::size_t entry) { return felt(source[entry]); });
    } else if (const ReliefImage* image = felt(block.source)) {
      each([&](std::size_t) { return image; });
    }
    return moves;
  }

  // Computes the blocks of `which` in `field` again. Returns those that changed.
  std::vector<std::int32_t> moveBlocks(SurfaceField& field, std::span<const std::int32_t> which,
                                       const std::vector<ReliefImage>& images) const {
    std::vector<std::uint8_t> differs(which.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, which.size(), 16),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        DistanceNodes moved, before;
                        for (std::size_t i = range.begin(); i < range.end(); ++i) {
                          const auto slot = static_cast<std::size_t>(which[i]);
                          std::shared_ptr<const DistanceBlock>& held = field.distance[slot];
                          const std::shared_ptr<const DistanceBlock>& own = base->distance[slot];
                          held->unpack(before);
                          if (held == own)
                            moved = before;
                          else
                            own->unpack(moved);
                          const bool moves = move(slot, images, moved);
                          differs[i] = !same(moved, before);
                          if (!differs[i]) continue;
                          held = moves ? std::make_shared<const DistanceBlock>(moved) : own;
                        }
                      });
    std::vector<std::int32_t> changed;
    for (std::size_t i = 0; i < which.size(); ++i)
      if (differs[i]) changed.push_back(which[i]);
    return changed;
  }

  void moveCoarse(SurfaceField& field, const std::vector<ReliefImage>& images,
                  const ReliefRange& range) const {
    const Index3 n{base->blocks[0] + 1, base->blocks[1] + 1, base->blocks[2] + 1};
    const auto fall = [&](std::size_t i) {
      const CoarseLookup& foot = feet.coarse[i];
      const ReliefImage& image = images[static_cast<std::size_t>(foot.source)];
      return image.isFlat() ? 0.0F : image.at(foot.uv);
    };
    const auto mean = [&](const Index3& at) {
      float sum = 0;
      int count = 0;
      for (int c = 0; c < 27; ++c) {
        const Index3 to{at[0] + c % 3 - 1, at[1] + c / 3 % 3 - 1, at[2] + c / 9 - 1};
        if (to[0] < 0 || to[1] < 0 || to[2] < 0 || to[0] >= n[0] || to[1] >= n[1] || to[2] >= n[2])
          continue;
        const auto i = static_cast<std::size_t>((to[2] * n[1] + to[1]) * n[0] + to[0]);
        if (feet.coarse[i].source < CoarseLookup::kFlat) continue;
        if (feet.coarse[i].source >= 0) sum += fall(i);
        ++count;
      }
      return count > 0 ? sum / static_cast<float>(count) : 0.0F;
    };
    const auto raised = static_cast<float>(range.high / voxel());
    field.coarse = base->coarse;
    for (std::size_t i = 0; i < field.coarse.size(); ++i) {
      float& phi = field.coarse[i].phi;
      const std::int32_t source = feet.coarse[i].source;
      if (source >= 0) {
        phi -= fall(i);
      } else if (source == CoarseLookup::kMean) {
        const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
        phi -= mean({static_cast<int>(i % nx), static_cast<int>(i / nx % ny),
                     static_cast<int>(i / (nx * ny))});
      } else if (source == CoarseLookup::kOutside) {
        phi = std::max(phi - raised, 0.0F);
      }
    }
  }

  // Returns `from` with the blocks of `which` computed again.
  std::shared_ptr<const SurfaceField> made(const SurfaceField& from,
                                           std::span<const std::int32_t> which,
                                           std::span<const ReliefInput> sources,
                                           const ReliefRange& range) const {
    const double highest = std::max(range.high, -range.low);
    if (highest == 0) return base;
    auto field = std::make_shared<SurfaceField>(from);
    const std::vector<ReliefImage> images = imagesOf(sources, voxel());
    field->band = base->band - highest / voxel();
    updateSamples(*field, moveBlocks(*field, which, images), *base);
    if (!field->coarse.empty()) moveCoarse(*field, images, range);
    return field;
  }
};

ReliefBake::ReliefBake(std::shared_ptr<const SurfaceField> base, const TriangleMesh& mesh,
                       std::span<const ReliefInput> sources, Progress& progress) {
  if (base->face.size() != base->blockCount())
    throw std::invalid_argument("ReliefBake: the field has no face layer");
  checkSources(sources, mesh);
  auto impl = std::make_unique<Impl>();
  impl->base = withSamples(std::move(base));
  impl->layout.assign(sources.begin(), sources.end());
  for (ReliefInput& source : impl->layout) source.image = nullptr;
  impl->feet = reliefLookups(*impl->base, mesh, sources, progress);
  for (std::size_t slot = 0; slot < impl->feet.block.size(); ++slot)
    if (impl->feet.block[slot].source != BlockLookups::kNone)
      impl->slots.push_back(static_cast<std::int32_t>(slot));
  impl_ = std::move(impl);
}

ReliefBake::~ReliefBake() = default;

std::shared_ptr<const SurfaceField> ReliefBake::baked(std::span<const ReliefInput> sources) const {
  impl_->check(sources);
  return impl_->made(*impl_->base, impl_->slots, sources, impl_->rangeThatFits(sources));
}

std::shared_ptr<const SurfaceField>
ReliefBake::updateBaked(const SurfaceField& before, std::span<const ReliefInput> old_sources,
                        std::span<const ReliefInput> sources) const {
  impl_->check(old_sources);
  impl_->check(sources);
  const ReliefRange range = impl_->rangeThatFits(sources);
  std::vector<std::vector<UvBox>> boxes;
  std::size_t all = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    boxes.push_back(differences(old_sources[i], sources[i]));
    all += boxes.back().size();
  }
  const auto sees = [&](const BlockLookups& feet) {
    const auto any = [&](const std::vector<UvBox>& of) {
      return std::any_of(of.begin(), of.end(), [&](const UvBox& box) { return meet(feet, box); });
    };
    if (feet.source == BlockLookups::kMixed) return std::any_of(boxes.begin(), boxes.end(), any);
    return any(boxes[static_cast<std::size_t>(feet.source)]);
  };
  std::vector<std::int32_t> which;
  if (all > 0)
    for (const std::int32_t slot : impl_->slots)
      if (sees(impl_->feet.block[static_cast<std::size_t>(slot)])) which.push_back(slot);
  return impl_->made(before, which, sources, range);
}

std::size_t ReliefBake::bytes() const {
  return impl_->feet.bytes() + impl_->slots.size() * sizeof(impl_->slots[0]);
}

} // namespace patina
