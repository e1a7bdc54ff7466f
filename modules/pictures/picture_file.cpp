#include "pictures/picture_file.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string_view>

#include "core/error.h"
#include "core/file.h"
#include "pictures/image_library.h"

namespace patina {
namespace {

constexpr ImageLimits kPictureLimits{16384, std::size_t{1} << 28, 4};

// Files begin with the top row, images in memory with the bottom one.
void flip(ImageRows& rows) {
  const std::size_t size = rows.rowSize();
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

} // namespace

bool isPictureByContent(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(32, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  const std::string_view all(head);
  const auto has = [&](std::string_view magic, std::size_t at = 0) {
    return all.substr(at, magic.size()) == magic;
  };
  using namespace std::string_view_literals;
  // A bitmap's two letters are too few; its next field is the size of a header.
  const bool bitmap =
      has("BM"sv) && (all[14] == 12 || (all[14] >= 40 && all[14] <= 124)) && has("\0\0\0"sv, 15);
  const bool portable = head[0] == 'P' &&
                        ((head[1] >= '1' && head[1] <= '6') || head[1] == 'f' || head[1] == 'F') &&
                        (head[2] == '\n' || head[2] == '\r' || head[2] == ' ' || head[2] == '\t');
  const bool heif = has("ftyp"sv, 4) &&
                    (has("heic"sv, 8) || has("heix"sv, 8) || has("mif1"sv, 8) || has("avif"sv, 8));
  return has("\xff\xd8\xff"sv) || has("\x89PNG\r\n\x1a\n"sv) || has("II*\0"sv) || has("MM\0*"sv) ||
         has("II+\0"sv) || has("MM\0+"sv) || (has("RIFF"sv) && has("WEBP"sv, 8)) || has("GIF8"sv) ||
         has("\x76\x2f\x31\x01"sv) || has("#?RADIANCE"sv) || has("\0\0\0\x0cjP  "sv) ||
         has("\xff\x4f\xff\x51"sv) || has("8BPS"sv) || has("SDPX"sv) || has("XPDS"sv) || bitmap ||
         portable || heif;
}

Picture readPicture(const std::filesystem::path& path) {
  const std::string name = path.string();
  // Replaces the library's messages for files on which it would fail or crash.
  std::error_code code;
  if (!std::filesystem::exists(path, code)) throw FileError(name, 0, "does not exist");
  if (!std::filesystem::is_regular_file(path, code)) throw FileError(name, 0, "is not a file");
  if (std::filesystem::file_size(path, code) == 0) throw FileError(name, 0, "the file is empty");
  ImageRows rows;
  const std::string cause = imageLibrary(name).read_file(name, kPictureLimits, rows);
  if (!cause.empty()) throw FileError(name, 0, "cannot be read as a picture: " + cause);
  requireFinite(rows, name);
  if (rows.premultiplied) divideByAlpha(rows);
  flip(rows);
  return {rows.width, rows.height, rows.channels, std::move(rows.value), rows.orientation};
}

void writePicture(const std::filesystem::path& path, const Picture& picture, int bits) {
  const std::string name = path.string();
  const std::string extension = extensionOf(path);
  if (extension != ".png" && extension != ".exr")
    throw FileError(name, 0, "a picture's name must end in .png or .exr");
  ImageRows rows{picture.width, picture.height, picture.channels, picture.texel, false};
  flip(rows);
  const ImageLibrary& library = imageLibrary(name);
  std::string bytes;
  const std::string cause =
      extension == ".png" ? library.write_png(rows, bits, bytes) : library.write_exr(rows, bytes);
  if (!cause.empty()) throw FileError(name, 0, "cannot be written: " + cause);
  writeFileAtomically(path, bytes);
}

} // namespace patina
