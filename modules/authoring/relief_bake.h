// Relief baked into the field, as the paper does it (K21): phi' = phi - s g(c).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/progress.h"
#include "field/surface_field.h"
#include "geometry/texture_layout.h"
#include "geometry/triangle_mesh.h"
#include "scene/tiled_image.h"

namespace patina {

// Relief of the object whose faces begin at first_face of the joint mesh.
struct ReliefSource {
  std::int32_t first_face = 0, faces = 0;
  std::shared_ptr<const CornerUvs> uvs;
  std::shared_ptr<const TiledImage> image; // null: flat
  double height = 0;                       // [m] of g = 1
};

// Where each node of the band reads its height. Immutable; made once for a field and its layouts.
// The band must hold |height| and kBandBeyondReach-like margin more; see compile_scene.h.
class ReliefBake {
 public:
  ReliefBake(std::shared_ptr<const SurfaceField> base, const TriangleMesh& mesh,
             std::span<const ReliefSource> sources, Progress& progress);
  ~ReliefBake();

  // Always from the base, so that twice is once and no image is the base itself, bit for bit. With
  // samples. Parallel.
  std::shared_ptr<const SurfaceField> baked(std::span<const ReliefSource> sources) const;
  // `before` = baked() of an image that differs only in the surface inside `region` (world):
  // blocks that cannot see it are shared.
  std::shared_ptr<const SurfaceField> rebaked(const SurfaceField& before,
                                              std::span<const ReliefSource> sources,
                                              const Box3& region) const;
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

} // namespace patina
