// A picture as plain floats.
#pragma once

#include <vector>

namespace patina {

// Row 0 at the bottom, as in tiled images; values in [0, 1] for 8 and 16 bit files. 1 channel grey,
// 2 grey and alpha, 3 RGB, 4 RGBA (not premultiplied).
struct Picture {
  int width = 0, height = 0, channels = 0;
  std::vector<float> texel; // channel fastest, then along a row
  // How a viewer turns it, EXIF's 1 to 8; the texels are as the file has them.
  int orientation = 1;
};

} // namespace patina
