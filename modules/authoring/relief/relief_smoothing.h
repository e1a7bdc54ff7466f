// A relief image through a Gaussian along the surface.
#pragma once

#include <memory>

#include "geometry/atlas/texel_map.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// Heat flow for the time deviation^2 / 2 between texels that are neighbours on the surface, by each
// face's metric: nothing is read across a chart's edge in the image. A constant keeps its value to
// 1e-6; a wave of length lambda keeps exp(-2 pi^2 deviation^2 / lambda^2) of its height, within
// 1.3 % of it from 1.5 texels on where texels are alike; within 3 % from 4 texels on where some are
// twice as long as others. Values below 1e-7 are 0. Where texels are less than a quarter of their
// mean size, or less than deviation / 64, they are smoothed as if they were that large. A wide flow
// goes on between cells of many texels, which quadratic splines fill and read; so its cost for each
// texel hardly depends on the deviation. Where texels are so large that a cell is wider than it, in
// one hundredth of the surface at most, the splines smooth more than was asked for.
//
// Holds what it learned of the texels that it has seen, 40 bytes each and less where the flow is
// wide, so that painting on costs little. Any thread; parallel; deterministic.
class ReliefSmoother {
 public:
  // `mesh` in metres; deviation [m] >= 0, invalid_argument otherwise.
  ReliefSmoother(std::shared_ptr<const TriangleMesh> mesh, std::shared_ptr<const CornerUvs> uvs,
                 std::shared_ptr<const TexelMap> texels, double deviation);
  ~ReliefSmoother();

  // Images of one channel, as large as the texel map (invalid_argument). Texels that show nothing
  // stay as they are.
  TiledImage smoothed(const TiledImage& relief) const;
  // smoothed(relief), bit for bit, where `result` is smoothed(before): only what sees a texel that
  // differs is made anew; images that share tiles are compared quickest.
  TiledImage resmoothed(const TiledImage& result, const TiledImage& before,
                        const TiledImage& relief) const;

  const std::shared_ptr<const TexelMap>& texels() const;
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
