// A picture as plain floats.
#pragma once

#include <vector>

namespace patina {

// Row 0 at the bottom, as in tiled images; values in [0, 1] for 8 and 16 bit files. 1 channel grey,
// 2 grey and alpha, 3 RGB, 4 RGBA (not premultiplied).
struct Picture {
  int width = 0, height = 0, channels = 0;
  std::vector<float> texel; // channel fastest, then along a row
  // EXIF orientation 1 to 8 for display; texels are stored as in the file.
  int orientation = 1;
};

} // namespace patina
