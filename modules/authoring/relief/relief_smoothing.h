// Smooths a relief image by a Gaussian along the surface.
#pragma once

#include <memory>

#include "geometry/atlas/texel_map.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// Diffusion for the time deviation^2 / 2 between texels adjacent on the surface, by each face's
// metric: values do not cross a chart's edge in the image. A constant keeps its value to 1e-6; a
// wave of length lambda is scaled by exp(-2 pi^2 deviation^2 / lambda^2), within 1.3 % from 1.5
// texels on for equal texels, and within 3 % from 4 texels on if some are twice as long as others.
// Values below 1e-7 become 0. Texels smaller than a quarter of the mean size, or than deviation /
// 64, are treated as that large. Wide diffusion runs between cells of many texels, with quadratic
// splines for restriction and prolongation, so that the time per texel hardly depends on the
// deviation. Where texels are so large that a cell exceeds the deviation, on at most one hundredth
// of the surface, the splines smooth more than requested.
//
// Caches data of visited texels, at most 40 bytes each, so that updates are cheap. Any thread;
// parallel; deterministic.
class ReliefSmoother {
 public:
  // `mesh` in metres; deviation [m] >= 0, invalid_argument otherwise.
  ReliefSmoother(std::shared_ptr<const TriangleMesh> mesh, std::shared_ptr<const CornerUvs> uvs,
                 std::shared_ptr<const TexelMap> texels, double deviation);
  ~ReliefSmoother();

  // Takes images of one channel and of the texel map's size (else invalid_argument). Unused texels
  // keep their values.
  TiledImage smoothed(const TiledImage& relief) const;
  // Equals smoothed(relief) bit for bit if `result` is smoothed(before). Recomputes only texels
  // affected by a changed one; comparison is fastest for images that share tiles.
  TiledImage updateSmoothed(const TiledImage& result, const TiledImage& before,
                            const TiledImage& relief) const;

  const std::shared_ptr<const TexelMap>& texels() const;
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina
