// Relief baked into the field, as the paper does it (K21): phi' = phi - s g(c).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "authoring/images/image_range.h"
#include "core/progress.h"
#include "field/store/surface_field.h"
#include "geometry/atlas/texture_layout.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// Relief of the object whose faces begin at first_face of the joint mesh.
struct ReliefSource {
  std::int32_t first_face = 0, faces = 0;
  std::shared_ptr<const CornerUvs> uvs;
  std::shared_ptr<const TiledImage> image;   // one channel; null: flat
  double height = 0;                         // [m] of g = 1
  std::shared_ptr<const ImageRange> range{}; // of the image; null: every texel is looked at
};

// Voxels of band that a baked field keeps beyond its relief: down to there contact is as deep as it
// looks.
inline constexpr double kBandBeyondRelief = 3;
// Voxels that engraving leaves of the nearer half of a plate: those that the cells of the new
// surface and their gradients read.
inline constexpr double kPlateBelowRelief = 2;

// Where each node of the band reads its height: the point of its nearest face that is closest to
// it. Immutable; made once for a field and its layouts. Any thread.
//
// Baked fields store the nodes that the base stores, moved. Their band is the base's less the
// highest relief up or down, for only that far from the new surface is every node stored. Coarse
// nodes inside move by the height at their foot, or by the mean of their neighbours' where they
// have no single one; those outside the band by the highest relief, so that they remain lower
// bounds. The back and the sides of a plate stay where they are. phi' is exact displacement along
// normals, not a distance: |grad phi'| is sqrt(1 + slope^2). Of several merged objects a node reads
// its face where that comes nearest, also where another object hides that place.
class ReliefBake {
 public:
  // `mesh` (world) is what the base was built from. Throws Cancelled; invalid_argument without a
  // face layer or if the sources do not fit the mesh.
  ReliefBake(std::shared_ptr<const SurfaceField> base, const TriangleMesh& mesh,
             std::span<const ReliefSource> sources, Progress& progress);
  ~ReliefBake();

  // Always from the base, so that twice is once and no image is the base itself, bit for bit;
  // blocks that relief leaves as they are are shared with it. With samples. Parallel. `sources` are
  // those of the constructor with any images and heights. Throws Error that names the band if less
  // than kBandBeyondRelief, or in a plate kPlateBelowRelief, would be left of it, or if an image
  // holds a value that is not finite.
  std::shared_ptr<const SurfaceField> baked(std::span<const ReliefSource> sources) const;
  // baked(sources), bit for bit; `before` = baked(old_sources). Only what reads a texel that
  // differs is made anew, wherever on the surface that is; images that share tiles are compared
  // quickest.
  std::shared_ptr<const SurfaceField> rebaked(const SurfaceField& before,
                                              std::span<const ReliefSource> old_sources,
                                              std::span<const ReliefSource> sources) const;
  std::size_t bytes() const; // beyond the base

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

} // namespace patina
