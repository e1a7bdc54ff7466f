#include "scene/paint/tiled_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace patina {
namespace {

bool isEmpty(const TiledImage::Tile& tile) {
  // Compares bits, so that -0 is stored and read back.
  return std::all_of(tile.begin(), tile.end(), [](float v) { return v == 0 && !std::signbit(v); });
}

} // namespace

TiledImage::TiledImage(int width, int height, int channels)
    : width_(width), height_(height), channels_(channels), across_(width / kTileSide) {
  for (const int side : {width, height})
    if (side < kMinImage || side > kMaxImage || side % kTileSide != 0)
      throw std::invalid_argument("TiledImage: bad size");
  if (channels < 1 || channels > 4) throw std::invalid_argument("TiledImage: bad channels");
  tiles_.resize(static_cast<std::size_t>(across_) * static_cast<std::size_t>(height / kTileSide));
  own_.set.resize(tiles_.size());
}

float* TiledImage::writable(std::size_t index) {
  std::shared_ptr<Tile>& tile = tiles_[index];
  char& own = own_.set[index];
  if (!tile)
    tile = std::make_shared<Tile>(static_cast<std::size_t>(kTileSide * kTileSide * channels_));
  else if (!own || tile.use_count() > 1) // a plain copy also shares it
    tile = std::make_shared<Tile>(*tile);
  own = true;
  return tile->data();
}

TiledImage TiledImage::published() {
  own_.set = sharedCopy(own_.set);
  return *this;
}

void TiledImage::dropEmptyTiles() {
  for (std::shared_ptr<Tile>& tile : tiles_)
    if (tile && isEmpty(*tile)) tile.reset();
}

std::size_t TiledImage::bytes() const {
  std::size_t bytes = tiles_.size() * sizeof(tiles_[0]);
  for (const std::shared_ptr<Tile>& tile : tiles_)
    if (tile) bytes += sizeof(Tile) + tile->size() * sizeof(float);
  return bytes;
}

double TiledImage::sample(double u, double v, int channel) const {
  const double x = std::clamp(u * width_ - 0.5, 0.0, width_ - 1.0);
  const double y = std::clamp(v * height_ - 0.5, 0.0, height_ - 1.0);
  const int i = std::min(static_cast<int>(x), width_ - 2);
  const int j = std::min(static_cast<int>(y), height_ - 2);
  const double a = x - i, b = y - j;
  const double low = (1 - a) * static_cast<double>(at(i, j, channel)) +
                     a * static_cast<double>(at(i + 1, j, channel));
  const double high = (1 - a) * static_cast<double>(at(i, j + 1, channel)) +
                      a * static_cast<double>(at(i + 1, j + 1, channel));
  return (1 - b) * low + b * high;
}

bool same(const TiledImage& a, const TiledImage& b) {
  if (a.width() != b.width() || a.height() != b.height() || a.channels() != b.channels())
    return false;
  for (std::size_t i = 0; i < a.tileCount(); ++i) {
    const auto& left = a.sharedTile(i);
    const auto& right = b.sharedTile(i);
    if (left == right) continue;
    if (!left || !right) {
      if (!isEmpty(left ? *left : *right)) return false;
    } else if (std::memcmp(left->data(), right->data(), left->size() * sizeof(float)) != 0) {
      return false;
    }
  }
  return true;
}

} // namespace patina
