#include "workspace/painted_image.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "pictures/image_library.h"

namespace patina {
namespace {

// Of the tiles that are there; the rest stays 0.
template <typename Visit> void forEachRow(const TiledImage& image, const Visit& visit) {
  const auto channels = static_cast<std::size_t>(image.channels());
  const std::size_t width = static_cast<std::size_t>(image.width()) * channels;
  const auto height = static_cast<std::size_t>(image.height());
  const auto across = static_cast<std::size_t>(image.tilesAcross());
  constexpr auto kSide = static_cast<std::size_t>(kTileSide);
  for (std::size_t index = 0; index < image.tileCount(); ++index) {
    for (std::size_t row = 0; row < kSide; ++row) {
      const std::size_t from_top = height - 1 - (index / across * kSide + row);
      visit(index, row * kSide * channels, from_top * width + index % across * kSide * channels,
            kSide * channels);
    }
  }
}

} // namespace

std::string exrBytes(const TiledImage& image) {
  ImageRows rows{image.width(), image.height(), image.channels(), {}, false};
  rows.value.assign(rows.rowSize() * static_cast<std::size_t>(rows.height), 0.0f);
  forEachRow(image, [&](std::size_t tile, std::size_t from, std::size_t to, std::size_t size) {
    if (const float* values = image.tile(tile))
      std::copy_n(values + from, size, rows.value.data() + to);
  });
  requireFinite(rows, "image");
  std::string bytes;
  const std::string cause = imageLibrary("image").write_exr(rows, bytes);
  if (!cause.empty()) throw Error("an image cannot be stored: " + cause);
  return bytes;
}

TiledImage parseExr(std::string_view bytes, int channels, const std::string& name) {
  if (bytes.empty()) throw FileError(name, 0, "the file is empty");
  ImageRows rows;
  const ImageLimits limits{kMostImage, std::size_t{kMostImage} * kMostImage * 4, 5};
  const std::string cause = imageLibrary(name).read_exr(bytes, limits, rows);
  if (!cause.empty()) throw FileError(name, 0, "cannot be read as an EXR image: " + cause);
  const auto fits = [](int side) { return side >= kLeastImage && side % kTileSide == 0; };
  if (rows.channels != channels || !fits(rows.width) || !fits(rows.height)) {
    throw FileError(name, 0,
                    "is not a painted image: " + std::to_string(rows.width) + " x " +
                        std::to_string(rows.height) + " texels of " +
                        std::to_string(rows.channels) + " channels where " +
                        std::to_string(channels) + " and multiples of " +
                        std::to_string(kTileSide) + " were expected");
  }
  requireFinite(rows, name);
  TiledImage image(rows.width, rows.height, channels);
  forEachRow(image, [&](std::size_t tile, std::size_t to, std::size_t from, std::size_t size) {
    const float* row = rows.value.data() + from;
    const bool any =
        std::any_of(row, row + size, [](float v) { return v != 0 || std::signbit(v); });
    if (any) std::copy_n(row, size, image.writable(tile) + to);
  });
  return image;
}

} // namespace patina
