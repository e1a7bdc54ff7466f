// A relief image from a function.
#pragma once

#include <functional>
#include <memory>

#include "scene/paint/tiled_image.h"

namespace patina::test {

using Height = std::function<double(double u, double v)>;

// Evaluates g at the texels' centres; tiles where it is 0 stay absent.
inline std::shared_ptr<TiledImage> reliefImage(int size, const Height& g) {
  auto image = std::make_shared<TiledImage>(size, size, 1);
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      const double value = g((i + 0.5) / size, (j + 0.5) / size);
      if (value != 0)
        image->writable(image->tileOf(i, j))[image->offsetOf(i, j)] = static_cast<float>(value);
    }
  return image;
}

} // namespace patina::test
