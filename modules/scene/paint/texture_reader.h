// Fast path for Fourier textures: without an image, away from edges.
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "scene/paint/relief_surface.h"
#include "scene/paint/texture_hit.h"

namespace patina {

// A view of the surface's faces and textures, which must outlive it.
class TextureReader {
 public:
  explicit TextureReader(const ReliefSurface& relief);

  // Evaluates as reliefAt() does, without the second derivative. `at` must be ReliefAt{}. Returns
  // unchanged, if readClosest() is needed: near an edge, with an image, or for an invalid face.
  bool read(const Vec3& c, std::int32_t near_face, ReliefAt& at) const noexcept {
    if (static_cast<std::size_t>(near_face) >= faces_) return false;
    // The kernel writes height and rate as one array.
    static_assert(offsetof(PatchAt, height) == 0 && offsetof(PatchAt, rate) == sizeof(double) &&
                  std::is_standard_layout_v<PatchAt>);
    TextureHit foot;
    kernel_(table_, textures_->table(), c.x(), c.y(), c.z(), near_face, foot, &at.height);
    if (foot.face < 0) return false;
    at.face = foot.face;
    at.distance = static_cast<double>(std::abs(foot.above));
    if (foot.patch && foot.patch->texture->line.cells) {
      at.along = Vec3(foot.patch->x);
      textures_->take(*foot.patch, c, at);
    } else if (foot.patch) {
      textures_->read(foot.face, c, at);
    }
    return true;
  }

 private:
  FaceTable table_{};
  std::size_t faces_ = 0; // faces to start from; 0 if there is an image
  const TexturePatches* textures_;
  TextureKernel kernel_;
};

} // namespace patina
