// How high a relief may be before touching it buzzes (F7).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geometry/atlas/texel_map.h"
#include "scene/device_model.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// A texture under the normal force P makes a lateral stiffness of P |h''|; above 2 b / T, or
// 2 b / T / (1 + 2 n) with n samples of delay, nothing settles on it, whatever the surface's own
// stiffness.
//
// h'' is taken by second differences over one texel, along the surface by the face's own metric, in
// the direction where it is largest, wherever all nine texels show one piece of the surface. What
// is a texel wide counts, noise of the image too: it is felt. Smoothing is the cure
// (relief_smoothing.h).
struct ReliefLimit {
  double highest = 0;   // [m], |height|
  double curvature = 0; // [1/m], worst |h''| along the surface
  // [m], 2 pi sqrt(amplitude / curvature), amplitude half the difference of highest and lowest: of
  // a sine as curved. 0 if flat.
  double wavelength = 0;
  // [m] of `highest` on the device, pressed as hard as the force limit P lets the servo press
  // back: of a sine 2 b lambda^2 / (4 pi^2 P T). Absent without a device and for a relief without
  // curvature.
  std::optional<double> admissible;
};
// The h'' of ReliefLimit for images of one size on one layout, kept by tile: a version that shares
// tiles with a known one costs what it changed and the tiles about it.
class BendMap {
 public:
  BendMap(std::shared_ptr<const TriangleMesh> mesh, std::shared_ptr<const CornerUvs> uvs, int width,
          int height);
  ~BendMap();

  // Worst |h''| [1/m] by tile for a height of 1 m at g = 1; `image` of one channel. `known` is that
  // of `before`, both null: every texel is looked at. The result does not depend on them. Parallel.
  std::vector<float> byTile(const TiledImage& image, const TiledImage* before = nullptr,
                            const std::vector<float>* known = nullptr) const;
  bool fits(const CornerUvs& uvs, int width, int height) const; // the same coordinates, by address
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// `mesh` in metres, `relief` of one channel, force_limit > 0 [N]. Parallel.
ReliefLimit reliefLimit(const TriangleMesh& mesh, const TextureLayout& layout,
                        const TiledImage& relief, double height,
                        const std::optional<DeviceModel>& device, double force_limit);

} // namespace patina
