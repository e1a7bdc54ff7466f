// How high a relief may be before touching it buzzes (F7), and its smoothing.
#pragma once

#include <memory>
#include <optional>

#include "geometry/texel_map.h"
#include "scene/device_model.h"
#include "scene/tiled_image.h"

namespace patina {

// A texture under the normal force P makes a lateral stiffness of P |h''|; above 2 b / T nothing
// settles on it, whatever the surface's own stiffness.
struct ReliefLimit {
  double highest = 0;               // [m], |height|
  double curvature = 0;             // [1/m], worst |h''| along the surface
  double wavelength = 0;            // [m], 2 pi sqrt(amplitude / curvature): of a sine as curved
  std::optional<double> admissible; // [m] of `highest` at 1 N on the scene's device; absent without
};
ReliefLimit reliefLimit(const TriangleMesh& mesh, const TextureLayout& layout,
                        const TiledImage& relief, double height,
                        const std::optional<DeviceModel>& device);

// The image through a Gaussian of `deviation` [m] along the surface, chart by chart, without
// reading across a chart's edge in the image. Deterministic.
TiledImage smoothed(const TiledImage& relief, const TriangleMesh& mesh, const TextureLayout& layout,
                    const TexelMap& texels, double deviation);

} // namespace patina
