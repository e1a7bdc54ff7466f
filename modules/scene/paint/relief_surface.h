// A mesh with relief for the servo: height and slope at the closest point, from an image (K21),
// Fourier textures (A24), or both.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/atlas/texture_layout.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/fourier/patch_table.h"
#include "scene/fourier/texture_mappings.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// Faces of one object with Fourier textures, for the servo (A24).

// Texture of a face and its weight: 1 except where it fades out.
struct TextureWeight {
  const HapticTexture* texture = nullptr; // null: none
  double weight = 0;
  Vec3 slope = Vec3::Zero(); // gradient of the weight [1/m]
};

struct PatchAt {
  double height = 0; // [m], outward; zero mean for a single texture
  // Gradient over the face, dimensionless, as two factors: the direction of a line's texture is
  // known before its rate, so that a tick can transform it meanwhile.
  double rate = 0;
  Vec3 along = Vec3::Zero();
  TextureWeight texture;

  Vec3 slope() const noexcept { return rate * along; }
  void setSlope(const Vec3& slope) noexcept {
    rate = 1;
    along = slope;
  }
};

// Coordinates are affine over a face, so that neighbours with equal coordinates at an edge's ends
// agree along it. A texture fades to zero, smoothly over one ring of faces, towards faces without a
// known texture, with another one, or across a seam at which its height jumps. If no corner is
// farther inside than that, it ends abruptly.
class TexturePatches {
 public:
  // mesh: the object's, world frame. Allocates 4 bytes per face, 80 per textured and 32 per fading
  // one.
  TexturePatches(const TriangleMesh& mesh, const TextureMappings& laid);
  TexturePatches(const TexturePatches&) = delete;
  TexturePatches& operator=(const TexturePatches&) = delete;

  // p [m, world] on or near the face. Servo thread: no allocation. hessian, if given, receives the
  // second derivative of the height over the face [1/m].
  PatchAt at(std::int32_t face, const Vec3& p, Eigen::Matrix3d* hessian = nullptr) const noexcept {
    PatchAt found;
    read(face, p, found, hessian);
    return found;
  }
  // The same into `found`, which must be PatchAt{}.
  void read(std::int32_t face, const Vec3& p, PatchAt& found,
            Eigen::Matrix3d* hessian = nullptr) const noexcept;
  // Completes `found`, which holds height and slope of the patch's texture at p.
  void take(const TexturePatch& patch, const Vec3& p, PatchAt& found,
            Eigen::Matrix3d* hessian = nullptr) const noexcept {
    found.texture.texture = patch.texture->texture;
    found.texture.weight = 1;
    if (patch.fade >= 0) fadeOut(patch, p, found, hessian);
  }
  const PatchTable& table() const noexcept { return table_; } // view

  double highest() const { return highest_; } // largest |height| [m]
  double maxCurvature() const {
    return max_curvature_;
  } // largest |h''| along a face, sampled, slivers' fades reduced [1/m]
  double stiffest() const { return stiffest_; } // largest known [N/m]; 0: none
  std::size_t bytes() const;

 private:
  struct Fade {
    double at = 0;             // value at middle_
    Vec3 slope = Vec3::Zero(); // gradient over the face
  };
  class InnerCorners;

  void fadeOut(const TexturePatch& patch, const Vec3& p, PatchAt& found,
               Eigen::Matrix3d* hessian) const noexcept;

  Vec3 middle_ = Vec3::Zero();
  std::vector<std::int32_t> patch_of_; // per face; -1: none
  std::vector<TexturePatch> patches_;
  std::vector<PatchTexture> patch_textures_; // lines of textures_
  PatchTable table_{};
  std::vector<Fade> fades_;
  std::vector<std::shared_ptr<const HapticTexture>> textures_;
  double highest_ = 0, max_curvature_ = 0, stiffest_ = 0;
};

// Corners, texture coordinates and neighbours of one object's faces, packed. Immutable; made once
// for an object and a layout, for any paint. uvs: empty if no image is read.
class ReliefFaces;
std::shared_ptr<const ReliefFaces> reliefFaces(const TriangleMesh& world_mesh,
                                               const CornerUvs& uvs);
std::size_t bytes(const ReliefFaces& faces);

struct ReliefSurface {
  std::shared_ptr<const ReliefFaces> faces;
  std::shared_ptr<const TiledImage> image;          // smoothed; null: no image
  double height = 0;                                // [m] at an image value of 1
  std::shared_ptr<const TexturePatches> textures{}; // null: none
};

// Sum of image and texture.
struct ReliefAt : PatchAt {
  std::int32_t face = -1; // face of the object; a good start for the next query nearby
  double distance = 0;    // [m], from c to the mesh
};

// Largest overshoot of the cubic interpolation relative to |g| of the texels, along both axes.
inline constexpr double kReliefOvershoot = 1.265625; // (9/8)^2

// Servo thread: no allocation. c: a point on or near the mesh [m], world; near_face: a nearby face
// of the object, from which the closest one is reached across edges. Face -1 (or an invalid one):
// no height.
//
// Interpolates the image with Catmull-Rom cubics. A bilinear surface would do except for its slope,
// which jumps between texels, as would the force; here it is continuous and the derivative of the
// height. Error O(texel^3) instead of O(texel^2). May overshoot between differing texels, by at
// most an eighth of a step along each axis. Reads beyond a chart's gutter with a weight of half a
// per cent.
// hessian, if given, receives the second derivative of the height along the surface [1/m], which
// jumps at texel centres.
ReliefAt reliefAt(const ReliefSurface& relief, const Vec3& c, std::int32_t near_face,
                  Eigen::Matrix3d* hessian = nullptr) noexcept;

// The same into `at`, which must be ReliefAt{}, without the fast path.
void readClosest(const ReliefSurface& relief, const Vec3& c, std::int32_t near_face, ReliefAt& at,
                 Eigen::Matrix3d* hessian = nullptr) noexcept;

} // namespace patina
