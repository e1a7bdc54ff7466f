// Largest relief height without instability on contact (F7).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geometry/atlas/texel_map.h"
#include "scene/device_model.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// A texture under the normal force P has a lateral stiffness of P |h''|. Above 2 b / T, or 2 b / T
// / (1 + 2 n) with n samples of delay, contact is unstable at any stiffness of the surface.
//
// h'' comes from second differences over one texel, along the surface by the face's own metric, in
// the direction of its maximum, if all nine texels show one piece of the surface. Details of one
// texel count, including image noise, because they can be felt; relief_smoothing.h reduces them.
struct ReliefLimit {
  double highest = 0;   // [m], |height|
  double curvature = 0; // [1/m], largest |h''| along the surface
  // [m], 2 pi sqrt(amplitude / curvature) with half the height range as amplitude: the wavelength
  // of a sine of equal curvature. 0 if flat.
  double wavelength = 0;
  // [m], maximum stable `highest` on the device at the force limit P: 2 b lambda^2 / (4 pi^2 P T)
  // for a sine. Absent without a device or without curvature.
  std::optional<double> admissible;
};
// h'' of ReliefLimit for images of one size on one layout, kept per tile, so that an update reads
// only changed tiles and their neighbours.
class CurvatureMap {
 public:
  CurvatureMap(std::shared_ptr<const TriangleMesh> mesh, std::shared_ptr<const CornerUvs> uvs,
               int width, int height);
  ~CurvatureMap();

  // Returns the largest |h''| [1/m] of each tile for a height of 1 m at an image value of 1. One
  // channel. `known` belongs to `before`; both null: reads every texel. The result does not depend
  // on them. Parallel.
  std::vector<float> perTile(const TiledImage& image, const TiledImage* before = nullptr,
                             const std::vector<float>* known = nullptr) const;
  bool fits(const CornerUvs& uvs, int width, int height) const; // the same coordinates by address
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
