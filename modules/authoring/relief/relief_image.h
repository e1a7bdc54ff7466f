// A relief image for the bake, and the difference of two versions. Internal to the bake.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "authoring/relief/relief_lookup.h"
#include "geometry/atlas/texel_map.h"

namespace patina {

// View of an image, which must outlive it. Missing tiles read as zeros.
class ReliefImage {
 public:
  ReliefImage() = default; // flat
  ReliefImage(const ReliefInput& source, double voxel);
  bool isFlat() const { return tiles_.empty(); }

  // Returns the decrease of phi [voxel]: bilinear between texel centres, clamped at the border.
  float at(const NodeUv& uv) const {
    const float x = std::clamp(uv[0] * width_ - 0.5F, 0.0F, width_ - 1);
    const float y = std::clamp(uv[1] * height_ - 0.5F, 0.0F, height_ - 1);
    const int i = std::min(static_cast<int>(x), last_i_),
              j = std::min(static_cast<int>(y), last_j_);
    const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
    const int ti = i % kTileSide, tj = j % kTileSide;
    const float* const* tile =
        &tiles_[static_cast<std::size_t>((j / kTileSide) * across_ + i / kTileSide)];
    float v00, v10, v01, v11;
    if (ti + 1 < kTileSide && tj + 1 < kTileSide) [[likely]] {
      const float* t = *tile + (tj * kTileSide + ti);
      v00 = t[0], v10 = t[1], v01 = t[kTileSide], v11 = t[kTileSide + 1];
    } else {
      v00 = texel(i, j), v10 = texel(i + 1, j), v01 = texel(i, j + 1), v11 = texel(i + 1, j + 1);
    }
    // Nested so that equal texels give exactly their value.
    const float low = v00 + a * (v10 - v00), high = v01 + a * (v11 - v01);
    return scale_ * (low + b * (high - low));
  }

 private:
  float texel(int i, int j) const {
    return tiles_[static_cast<std::size_t>((j / kTileSide) * across_ + i / kTileSide)]
                 [(j % kTileSide) * kTileSide + i % kTileSide];
  }

  std::vector<const float*> tiles_;
  int across_ = 0, last_i_ = 0, last_j_ = 0;
  float width_ = 0, height_ = 0, scale_ = 0;
};

// Range of height * image value [m] over all images, including 0. Throws Error for a non-finite
// value.
struct ReliefRange {
  double low = 0, high = 0;
};
ReliefRange reliefRange(std::span<const ReliefInput> sources);

// Returns the changed texels of each tile, for one-channel images of equal size.
std::vector<TexelBox> changedTexels(const TiledImage& before, const TiledImage& after);

// Part of the unit square in which look-ups may differ between two versions of a source, as boxes.
struct UvBox {
  NodeUv low, high;
};
std::vector<UvBox> differences(const ReliefInput& before, const ReliefInput& after);

} // namespace patina
