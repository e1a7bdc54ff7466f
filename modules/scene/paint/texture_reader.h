// Fourier textures as most ticks ask for them: alone on a surface, away from edges.
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "scene/paint/relief_surface.h"
#include "scene/paint/texture_look.h"

namespace patina {

// A view: faces and textures of the surface must outlive it.
class TextureReader {
 public:
  explicit TextureReader(const ReliefSurface& relief);

  // As reliefAt() without `bend`, into `at`, which is ReliefAt{}. False, and `at` as it was, where
  // readClosest() has to tell: by an edge, where there is an image, and without such a face.
  bool read(const Vec3& c, std::int32_t near_face, ReliefAt& at) const noexcept {
    if (static_cast<std::size_t>(near_face) >= faces_) return false;
    // What the look tells, in its order.
    static_assert(offsetof(PatchAt, height) == 0 && offsetof(PatchAt, rate) == sizeof(double) &&
                  std::is_standard_layout_v<PatchAt>);
    TextureFoot foot;
    look_(table_, textures_->table(), c.x(), c.y(), c.z(), near_face, foot, &at.height);
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
  std::size_t faces_ = 0; // that a look may begin at; none where there is an image
  const TexturePatches* textures_;
  TextureLook look_;
};

} // namespace patina
