#include "authoring/relief/relief_image.h"

#include <cmath>
#include <cstring>

#include "core/error.h"

namespace patina {
namespace {

constexpr int kTileTexels = kTileSide * kTileSide;

const float* zeros() {
  static constexpr std::array<float, kTileTexels> kZeros{};
  return kZeros.data();
}

const float* tileOrZeros(const TiledImage& image, std::size_t index) {
  const float* tile = image.tile(index);
  return tile ? tile : zeros();
}

bool isFlat(const ReliefInput& source) {
  return !source.image || source.height == 0;
}

// Returns the look-ups that read a texel of [i0, i1] x [j0, j1]: up to one texel away, plus the
// rounding of u * width.
UvBox around(int i0, int j0, int i1, int j1, const TiledImage& image) {
  constexpr double kRound = 0.01; // [texel]
  const auto at = [](double texel, int size) { return static_cast<float>(texel / size); };
  // Clamped coordinates beyond the border also read its texels.
  const auto low = [&](int i, int size) { return i == 0 ? -1.0F : at(i - 0.5 - kRound, size); };
  const auto high = [&](int i, int size) {
    return i == size - 1 ? 2.0F : at(i + 1.5 + kRound, size);
  };
  return {{low(i0, image.width()), low(j0, image.height())},
          {high(i1, image.width()), high(j1, image.height())}};
}

} // namespace

ReliefImage::ReliefImage(const ReliefInput& source, double voxel) {
  if (patina::isFlat(source)) return;
  const TiledImage& image = *source.image;
  bool any = false;
  tiles_.resize(image.tileCount());
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    any = any || image.tile(i);
    tiles_[i] = tileOrZeros(image, i);
  }
  if (!any) tiles_.clear();
  across_ = image.tilesAcross();
  last_i_ = image.width() - 2;
  last_j_ = image.height() - 2;
  width_ = static_cast<float>(image.width());
  height_ = static_cast<float>(image.height());
  scale_ = static_cast<float>(source.height / voxel);
}

ReliefRange reliefRange(std::span<const ReliefInput> sources) {
  ReliefRange range;
  for (const ReliefInput& source : sources) {
    if (isFlat(source)) continue;
    const TileRange own = (source.range ? *source.range : imageRange(*source.image)).all;
    if (!own.finite || !std::isfinite(source.height))
      throw Error("relief: the image holds a value that is not a finite number");
    for (const float g : {own.low, own.high}) {
      range.low = std::min(range.low, source.height * static_cast<double>(g));
      range.high = std::max(range.high, source.height * static_cast<double>(g));
    }
  }
  return range;
}

std::vector<TexelBox> changedTexels(const TiledImage& before, const TiledImage& after) {
  std::vector<TexelBox> boxes;
  for (std::size_t index = 0; index < after.tileCount(); ++index) {
    if (before.sharedTile(index) == after.sharedTile(index)) continue;
    const float *left = tileOrZeros(before, index), *right = tileOrZeros(after, index);
    int i0 = kTileSide, i1 = -1, j0 = kTileSide, j1 = -1;
    for (int j = 0; j < kTileSide; ++j) {
      const float *row = left + j * kTileSide, *other = right + j * kTileSide;
      if (std::memcmp(row, other, kTileSide * sizeof(float)) == 0) continue;
      j0 = std::min(j0, j);
      j1 = j;
      for (int i = 0; i < kTileSide; ++i) {
        if (std::memcmp(row + i, other + i, sizeof(float)) == 0) continue;
        i0 = std::min(i0, i);
        i1 = std::max(i1, i);
      }
    }
    if (i1 < 0) continue;
    const int i = static_cast<int>(index) % after.tilesAcross() * kTileSide,
              j = static_cast<int>(index) / after.tilesAcross() * kTileSide;
    boxes.push_back({i + i0, j + j0, i + i1 + 1, j + j1 + 1});
  }
  return boxes;
}

std::vector<UvBox> differences(const ReliefInput& before, const ReliefInput& after) {
  if (isFlat(before) && isFlat(after)) return {};
  const std::vector<UvBox> everywhere{{{-1, -1}, {2, 2}}};
  if (before.height != after.height || isFlat(before) || isFlat(after)) return everywhere;
  const TiledImage &a = *before.image, &b = *after.image;
  if (&a == &b) return {};
  if (a.width() != b.width() || a.height() != b.height()) return everywhere;
  std::vector<UvBox> boxes;
  for (const TexelBox& box : changedTexels(a, b))
    boxes.push_back(around(box.i0, box.j0, box.i1 - 1, box.j1 - 1, a));
  return boxes;
}

} // namespace patina
