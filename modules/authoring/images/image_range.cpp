#include "authoring/images/image_range.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace patina {
namespace {

TileRange rangeOf(const TiledImage::Tile& tile) {
  TileRange range;
  float poison = 0; // NaN as soon as a value is NaN or infinite
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

} // namespace patina
