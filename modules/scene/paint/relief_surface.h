// A mesh with its relief as the servo reads it: height and slope at the closest point, of an image
// (K21), of Fourier textures (A24), or of both together.
#pragma once

#include <cstdint>
#include <memory>

#include "geometry/atlas/texture_layout.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/fourier/texture_patches.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// Corners, texture coordinates and neighbours of one object's faces, packed. Immutable; made once
// for an object and a layout, whatever is painted later. uvs: none where no image is read.
class ReliefFaces;
std::shared_ptr<const ReliefFaces> reliefFaces(const TriangleMesh& world_mesh,
                                               const CornerUvs& uvs);
std::size_t bytes(const ReliefFaces& faces);

struct ReliefSurface {
  std::shared_ptr<const ReliefFaces> faces;
  std::shared_ptr<const TiledImage> image;          // as felt; absent: no image
  double height = 0;                                // [m] of g = 1
  std::shared_ptr<const TexturePatches> textures{}; // absent: none
};

// Height and slope are those of image and texture together.
struct ReliefAt : PatchAt {
  std::int32_t face = -1; // of the object; a good start for the next query nearby
  double distance = 0;    // [m], from c to the mesh
};

// What cubics may add to the greatest |g| between texels, along both axes.
inline constexpr double kReliefOvershoot = 1.265625; // (9/8)^2

// Servo thread: no allocation. c: a point on or near the mesh [m], world; near_face: a face of the
// object thought to be near, from which the closest one is reached across edges. Face -1 (or one
// that the object does not have): no height.
//
// The image passes through its texels by Catmull-Rom's cubics, which a bilinear surface would do as
// well but for its slope: that steps from texel to texel, and the force with it. Here it is
// continuous, and still the derivative of the height. Error O(texel^3), against O(texel^2). Between
// texels that differ it may overshoot, by an eighth of a step at most along each axis. Beyond a
// chart's gutter it reads with a weight of half a per cent.
// bend, where asked for, becomes the second derivative of the height along the surface [1/m]; at
// texels' centres it steps.
ReliefAt reliefAt(const ReliefSurface& relief, const Vec3& c, std::int32_t near_face,
                  Eigen::Matrix3d* bend = nullptr) noexcept;

// The same into `at`, which is ReliefAt{}, without a look for what is quick to find.
void readClosest(const ReliefSurface& relief, const Vec3& c, std::int32_t near_face, ReliefAt& at,
                 Eigen::Matrix3d* bend = nullptr) noexcept;

} // namespace patina
