// An image of floats in tiles that versions share; unpainted tiles are not stored.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "scene/paint/unique_flags.h"

namespace patina {

inline constexpr int kTileSide = 32; // texels
inline constexpr int kMinImage = 64; // texels a side; sizes are multiples of kTileSide
inline constexpr int kMaxImage = 4096;

// Unpainted values are 0. Row 0 is at v = 0 (see geometry/atlas/texel_map.h). Copies share tiles;
// writable() copies a shared tile. Any thread may read while no thread writes this image.
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
  std::size_t offsetOf(int i, int j) const { // offset in a tile
    return static_cast<std::size_t>(((j % kTileSide) * kTileSide + i % kTileSide) * channels_);
  }
  float at(int i, int j, int channel) const {
    const float* values = tile(tileOf(i, j));
    return values ? values[offsetOf(i, j) + static_cast<std::size_t>(channel)] : 0.0f;
  }
  // Returns the texels of a tile for writing, allocated or copied first if necessary. Threads may
  // write different tiles at once.
  float* writable(std::size_t index);
  // Returns a copy for other threads, which later writes do not change.
  TiledImage published();
  // Drops tiles that are 0 everywhere.
  void dropEmptyTiles();
  std::size_t bytes() const; // size of all tiles, shared or not

  // Bilinear between texel centres, clamped at the image's border; u, v in [0, 1].
  double sample(double u, double v, int channel) const;

 private:
  int width_, height_, channels_, across_;
  std::vector<std::shared_ptr<Tile>> tiles_;
  UniqueFlags<std::vector<char>> own_; // per tile; not bits, which neighbours would share
};

// Compares bitwise, tile by tile; a missing tile equals zeros.
bool same(const TiledImage& a, const TiledImage& b);

} // namespace patina
