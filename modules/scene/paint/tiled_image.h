// An image of floats in tiles that versions share: what was not painted is not stored.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "scene/paint/own_parts.h"

namespace patina {

inline constexpr int kTileSide = 32;   // texels
inline constexpr int kLeastImage = 64; // texels a side; sizes are multiples of kTileSide
inline constexpr int kMostImage = 4096;

// Values are 0 where nothing was painted. Row 0 is at v = 0 (see geometry/atlas/texel_map.h).
// Copies share tiles; writable() copies the one tile that is shared. Reading is safe on any thread
// while the image itself is not written.
class TiledImage {
 public:
  using Tile = std::vector<float>; // kTileSide^2 * channels, channel fastest, then i

  TiledImage(int width, int height, int channels); // throws invalid_argument for a bad size

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }
  int tilesAcross() const { return across_; }
  std::size_t tileCount() const { return tiles_.size(); }
  // nullptr = all 0. Index: (j / kTileSide) * tilesAcross() + i / kTileSide.
  const float* tile(std::size_t index) const {
    return tiles_[index] ? tiles_[index]->data() : nullptr;
  }
  const std::shared_ptr<Tile>& sharedTile(std::size_t index) const { return tiles_[index]; }
  std::size_t tileOf(int i, int j) const {
    return static_cast<std::size_t>(j / kTileSide) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(i / kTileSide);
  }
  std::size_t offsetOf(int i, int j) const { // in a tile
    return static_cast<std::size_t>(((j % kTileSide) * kTileSide + i % kTileSide) * channels_);
  }
  float at(int i, int j, int channel) const {
    const float* values = tile(tileOf(i, j));
    return values ? values[offsetOf(i, j) + static_cast<std::size_t>(channel)] : 0.0f;
  }
  // The texels of a tile for writing: allocated, or copied first unless they are its own. Threads
  // may write different tiles at once.
  float* writable(std::size_t index);
  // A copy for others; what is written from now on is not in it.
  TiledImage published();
  // Drops tiles that are 0 everywhere.
  void dropEmptyTiles();
  std::size_t bytes() const; // of all its tiles, shared or not

  // Bilinear between texel centres, clamped at the image's border; u, v in [0, 1].
  double sample(double u, double v, int channel) const;

 private:
  int width_, height_, channels_, across_;
  std::vector<std::shared_ptr<Tile>> tiles_;
  OwnParts<std::vector<char>> own_; // by tile; not bits, which neighbours would share
};

// Bitwise, tile by tile; an absent tile equals one of zeros.
bool same(const TiledImage& a, const TiledImage& b);

} // namespace patina
