// Bakes relief into the field, as in the paper (K21): phi' = phi - s g(c).
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "core/progress.h"
#include "field/store/surface_field.h"
#include "geometry/atlas/texture_layout.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// Minimum and maximum of an image, kept per tile, so that an update reads only changed tiles.
struct TileRange {
  float low = 0, high = 0; // range, including 0
  bool finite = true;      // all values are finite
  float highest() const { return std::max(high, -low); }
};

struct ImageRange {
  TileRange all;
  std::vector<TileRange> tiles;
};

// Covers all channels. `known` belongs to `before`, an image of any size; both null: reads every
// texel. The result does not depend on them. Parallel.
ImageRange imageRange(const TiledImage& image, const TiledImage* before = nullptr,
                      const ImageRange* known = nullptr);

// Relief of the object whose faces begin at first_face of the combined mesh.
struct ReliefInput {
  std::int32_t first_face = 0, faces = 0;
  std::shared_ptr<const CornerUvs> uvs;
  std::shared_ptr<const TiledImage> image;   // one channel; null: flat
  double height = 0;                         // [m] at an image value of 1
  std::shared_ptr<const ImageRange> range{}; // range of the image; null: computed from every texel
};

// Voxels of band that a baked field keeps beyond its relief, in which contact has its true depth.
inline constexpr double kBandMargin = 3;
// Voxels that engraving leaves in the nearer half of a sheet, as cells of the new surface and their
// gradients need them.
inline constexpr double kSheetMargin = 2;

// Positions in the image at which each node of the band reads its height: that of the closest point
// on its nearest face. Immutable; made once for a field and its layouts. Any thread.
//
// Baked fields store the same nodes, moved. Their band is the base's minus the largest |relief|,
// because only within that distance of the new surface is every node stored. Coarse nodes inside
// move by the height at their closest point, or by their neighbours' mean if it is not unique;
// those outside the band move by the largest relief and remain lower bounds. The back and sides of
// a sheet do not move. phi' is the exact displacement along normals, not a distance: |grad phi'| is
// sqrt(1 + slope^2). In a merged field a node uses its nearest face even where another object hides
// that point.
class ReliefBake {
 public:
  // `mesh` (world) is the mesh of the base. Throws Cancelled; invalid_argument without a face layer
  // or if the sources do not fit the mesh.
  ReliefBake(std::shared_ptr<const SurfaceField> base, const TriangleMesh& mesh,
             std::span<const ReliefInput> sources, Progress& progress);
  ~ReliefBake();

  // Bakes from the base, so that repeating it changes nothing and no image gives the base, bit for
  // bit; shares blocks that relief does not change. With samples. Parallel. `sources` are those of
  // the constructor with any images and heights. Throws Error that names the band if less than
  // kBandMargin, or kSheetMargin in a sheet, would remain, or if an image holds a value that is not
  // finite.
  std::shared_ptr<const SurfaceField> baked(std::span<const ReliefInput> sources) const;
  // Equals baked(sources) bit for bit; `before` = baked(old_sources). Recomputes only nodes that
  // read a changed texel, anywhere on the surface; comparison is fastest for images that share
  // tiles.
  std::shared_ptr<const SurfaceField> updateBaked(const SurfaceField& before,
                                                  std::span<const ReliefInput> old_sources,
                                                  std::span<const ReliefInput> sources) const;
  std::size_t bytes() const; // without the base

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

} // namespace patina
