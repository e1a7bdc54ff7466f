// Interface of the picture library, which is loaded at first use. Both sides are built together, so
// that C++ types may cross; exceptions may not.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

struct ImageRows {
  int width = 0, height = 0, channels = 0;
  std::vector<float> value; // channel fastest, the top row first
  bool premultiplied = false;
  int orientation = 1; // EXIF value

  std::size_t rowSize() const { // number of values
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  }
};

struct ImageLimits {
  int side = 0;           // texels
  std::size_t values = 0; // texels times channels
  int channels = 4;       // further channels of a file are skipped
};

// Each function returns an empty text, or the reason of the failure.
struct ImageLibrary {
  std::string (*read_file)(const std::string& path, const ImageLimits&, ImageRows& out);
  std::string (*read_exr)(std::string_view bytes, const ImageLimits&, ImageRows& out);
  std::string (*write_exr)(const ImageRows&, std::string& bytes);
  // 8 or 16 bits; values in [0, 1].
  std::string (*write_png)(const ImageRows&, int bits, std::string& bytes);
};

// The only exported symbol.
inline constexpr const char* kImageLibrarySymbol = "patinaImageLibrary";
using ImageLibraryFunction = const ImageLibrary*();

} // namespace patina
