// The least and the greatest value of an image, kept by tile: a version that shares tiles with a
// known one costs what it changed.
#pragma once

#include <algorithm>
#include <vector>

#include "scene/paint/tiled_image.h"

namespace patina {

struct TileRange {
  float low = 0, high = 0; // 0 is among the values
  bool finite = true;      // all of them
  float highest() const { return std::max(high, -low); }
};

struct ImageRange {
  TileRange all;
  std::vector<TileRange> tiles;
};

// Of all channels. `known` is that of `before`, an image of the same size or another; both null:
// every texel is looked at. The result does not depend on them. Parallel.
ImageRange imageRange(const TiledImage& image, const TiledImage* before = nullptr,
                      const ImageRange* known = nullptr);

} // namespace patina
