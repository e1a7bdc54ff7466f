// One object's faces with Fourier textures on them, as the servo reads them (A24).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"
#include "scene/fourier/laid_textures.h"
#include "scene/fourier/patch_table.h"

namespace patina {

// Which texture lies on a face, and how much of it there is: 1 but where it fades out.
struct TextureShare {
  const FeltTexture* of = nullptr; // none
  double share = 0;
  Vec3 slope = Vec3::Zero(); // of the share [1/m]
};

struct PatchAt {
  double height = 0; // [m], outward; of a texture alone, of mean zero
  // Its gradient over the face, dimensionless, in two factors: what a line's texture is read along
  // is known before what is read, and a tick can pull it back meanwhile.
  double rate = 0;
  Vec3 along = Vec3::Zero();
  TextureShare texture;

  Vec3 slope() const noexcept { return rate * along; }
  void setSlope(const Vec3& slope) noexcept {
    rate = 1;
    along = slope;
  }
};

// Coordinates are affine over a face, so that neighbours that agree on an edge's ends agree along
// it. Towards faces without a known texture, with another one, or with coordinates between which
// its height jumps (a seam), each texture fades to nothing, smoothly over the faces that touch
// them; where no corner of its faces is farther in than that, it ends as it is.
class TexturePatches {
 public:
  // mesh: the object's, world frame. Makes room for 4 bytes a face, 80 a textured one and 32 where
  // it fades.
  TexturePatches(const TriangleMesh& mesh, const LaidTextures& laid);
  TexturePatches(const TexturePatches&) = delete;
  TexturePatches& operator=(const TexturePatches&) = delete;

  // p [m, world] on or near the face. Servo thread: no allocation. bend, where asked for, becomes
  // the second derivative of the height over the face [1/m].
  PatchAt at(std::int32_t face, const Vec3& p, Eigen::Matrix3d* bend = nullptr) const noexcept {
    PatchAt found;
    read(face, p, found, bend);
    return found;
  }
  // The same into `found`, which is PatchAt{}.
  void read(std::int32_t face, const Vec3& p, PatchAt& found,
            Eigen::Matrix3d* bend = nullptr) const noexcept;
  // For a look that has put height and slope of the patch's texture at p into `found`.
  void take(const TexturePatch& patch, const Vec3& p, PatchAt& found,
            Eigen::Matrix3d* bend = nullptr) const noexcept {
    found.texture.of = patch.texture->of;
    found.texture.share = 1;
    if (patch.fade >= 0) fadeOut(patch, p, found, bend);
  }
  const PatchTable& table() const noexcept { return table_; } // a view

  double highest() const { return highest_; } // of |height| anywhere [m]
  double bend() const {
    return bend_;
  } // of |h''| along any face, by samples; of a sliver's fade less [1/m]
  double stiffest() const { return stiffest_; } // of the textures that say so [N/m]; 0: none does
  std::size_t bytes() const;

 private:
  struct Fade {
    double at = 0;             // middle_
    Vec3 slope = Vec3::Zero(); // over the face
  };
  class InnerCorners;

  void fadeOut(const TexturePatch& patch, const Vec3& p, PatchAt& found,
               Eigen::Matrix3d* bend) const noexcept;

  Vec3 middle_ = Vec3::Zero();
  std::vector<std::int32_t> patch_of_; // by face; -1: none
  std::vector<TexturePatch> patches_;
  std::vector<PatchTexture> patch_textures_; // of textures_
  PatchTable table_{};
  std::vector<Fade> fades_;
  std::vector<std::shared_ptr<const FeltTexture>> textures_;
  double highest_ = 0, bend_ = 0, stiffest_ = 0;
};

} // namespace patina
