#include "workspace/image_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/error.h"
#include "core/file.h"
#include "workspace/image_library.h"

namespace patina {
namespace {

constexpr ImageLimits kPictureLimits{16384, std::size_t{1} << 28, 4};

std::size_t rowSize(const ImageRows& rows) {
  return static_cast<std::size_t>(rows.width) * static_cast<std::size_t>(rows.channels);
}

// Files begin with the top row, images in memory with the bottom one.
void flip(ImageRows& rows) {
  const std::size_t size = rowSize(rows);
  for (std::size_t low = 0, high = static_cast<std::size_t>(rows.height); low + 1 < high; ++low) {
    --high;
    std::swap_ranges(rows.value.data() + low * size, rows.value.data() + (low + 1) * size,
                     rows.value.data() + high * size);
  }
}

void divideByAlpha(ImageRows& rows) {
  const auto channels = static_cast<std::size_t>(rows.channels);
  for (std::size_t texel = 0; texel < rows.value.size(); texel += channels) {
    const float alpha = rows.value[texel + channels - 1];
    if (!(alpha > 0)) continue;
    for (std::size_t c = 0; c + 1 < channels; ++c) rows.value[texel + c] /= alpha;
  }
}

std::string extensionOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

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

void requireFinite(const std::vector<float>& values, const std::string& name) {
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
    throw FileError(name, 0, "holds a value that is not a finite number");
}

} // namespace

Picture readPicture(const std::filesystem::path& path) {
  const std::string name = path.string();
  // Our own words for what the library would put in its own, or crash on.
  std::error_code code;
  if (!std::filesystem::exists(path, code)) throw FileError(name, 0, "does not exist");
  if (!std::filesystem::is_regular_file(path, code)) throw FileError(name, 0, "is not a file");
  if (std::filesystem::file_size(path, code) == 0) throw FileError(name, 0, "the file is empty");
  ImageRows rows;
  const std::string cause = imageLibrary(name).read_file(name, kPictureLimits, rows);
  if (!cause.empty()) throw FileError(name, 0, "cannot be read as a picture: " + cause);
  requireFinite(rows.value, name);
  if (rows.premultiplied) divideByAlpha(rows);
  flip(rows);
  return {rows.width, rows.height, rows.channels, std::move(rows.value)};
}

void writePicture(const std::filesystem::path& path, const Picture& picture) {
  const std::string name = path.string();
  const std::string extension = extensionOf(path);
  if (extension != ".png" && extension != ".exr")
    throw FileError(name, 0, "a picture's name must end in .png or .exr");
  ImageRows rows{picture.width, picture.height, picture.channels, picture.texel, false};
  flip(rows);
  const ImageLibrary& library = imageLibrary(name);
  std::string bytes;
  const std::string cause =
      (extension == ".png" ? library.write_png : library.write_exr)(rows, bytes);
  if (!cause.empty()) throw FileError(name, 0, "cannot be written: " + cause);
  writeFileAtomically(path, bytes);
}

std::string exrBytes(const TiledImage& image) {
  ImageRows rows{image.width(), image.height(), image.channels(), {}, false};
  rows.value.assign(rowSize(rows) * static_cast<std::size_t>(rows.height), 0.0f);
  forEachRow(image, [&](std::size_t tile, std::size_t from, std::size_t to, std::size_t size) {
    if (const float* values = image.tile(tile))
      std::copy_n(values + from, size, rows.value.data() + to);
  });
  requireFinite(rows.value, "image");
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
  requireFinite(rows.value, name);
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
