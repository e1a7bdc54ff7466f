#include "geometry/mesh/mesh_colors.h"

#include <algorithm>
#include <cmath>

namespace patina {

void scaleColors(std::vector<Rgba>& colors, double white) {
  const auto isColor = [](const Rgba& c) {
    return std::isfinite(c[0]) && std::isfinite(c[1]) && std::isfinite(c[2]);
  };
  if (white == 0) {
    const auto isByte = [&](const Rgba& c) {
      return isColor(c) && std::max({c[0], c[1], c[2]}) >= 2.0F;
    };
    white = std::any_of(colors.begin(), colors.end(), isByte) ? 255 : 1;
  }
  const auto full = static_cast<float>(white);
  for (Rgba& color : colors) {
    if (!isColor(color)) color = {};
    for (std::size_t k = 0; k < 3; ++k) color[k] = std::clamp(color[k] / full, 0.0F, 1.0F);
  }
}

} // namespace patina
