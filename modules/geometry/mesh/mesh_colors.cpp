#include "geometry/mesh/mesh_colors.h"

#include <algorithm>
#include <cmath>

namespace patina {

void scaleColors(std::vector<Rgba>& colors, double white) {
  if (white == 0) {
    const auto above = [](const Rgba& c) { return std::max({c[0], c[1], c[2]}) > 1.0F; };
    white = std::any_of(colors.begin(), colors.end(), above) ? 255 : 1;
  }
  const auto full = static_cast<float>(white);
  for (Rgba& color : colors) {
    if (!std::isfinite(color[0]) || !std::isfinite(color[1]) || !std::isfinite(color[2]))
      color = {};
    for (std::size_t k = 0; k < 3; ++k) color[k] = std::clamp(color[k] / full, 0.0F, 1.0F);
  }
}

} // namespace patina
