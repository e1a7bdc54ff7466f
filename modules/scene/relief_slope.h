// Slope of painted relief at a texel, for shading.
#pragma once

#include <array>
#include <cstdint>

#include "geometry/atlas/texel_map.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// View of its sources, which must outlive it. One thread; fast along the texels of a face.
class ReliefSlope {
 public:
  ReliefSlope(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& texels);

  // Returns the gradient of the relief value along the surface at texel (i, j) [1/m], in the mesh's
  // frame and tangent to the texel's face. Central differences, one-sided if a neighbour shows
  // another place of the surface or repeats the chart's edge, so that no seam is visible. Second
  // order in the texel inside a chart, first at its edge. Zero for an unused texel.
  Vec3 at(const TiledImage& g, int i, int j) const;

 private:
  // Values common to all texels of a face, computed again when the face changes.
  struct Face {
    std::int32_t index = -1;
    bool flat = false;                       // without area, in space or in the image
    Vec3 first, along_u, along_v;            // barycentric of texel (i, j): first + i u + j v
    Eigen::Matrix<double, 3, 2> gradient_of; // from differences per texel along i and j
    double step_u = 0, step_v = 0;           // texel size on the surface [m]
  };
  struct Place {
    std::int32_t face = -1;
    Vec3 barycentric = Vec3::Zero();
    bool covered = false; // the face covers the texel's centre
  };
  struct Slope {
    Vec3 gradient = Vec3::Zero();
    bool whole = false; // valid along both axes of the image
  };
  Face faceOf(std::int32_t index) const;
  Place placeOf(int i, int j, Face& known) const;
  Vec3 point(const Place& place) const;
  Slope inside(const TiledImage& g, int i, int j, const Place& place, const Face& face) const;

  const TriangleMesh* mesh_;
  const CornerUvs* uvs_;
  const TexelMap* texels_;
  mutable Face last_; // last face, for one thread
};

// Largest distance along either axis of texels that affect the slope.
inline constexpr int kSlopeReach = kGutter + 2;

// Three bytes per texel, finer near zero; slopes beyond 2 count as 2. kSlopeShader in
// image_surface.cpp decodes them.
inline constexpr double kMaxEncodedSlope = 2;
std::array<unsigned char, 3> encodedSlope(const Vec3& slope);

} // namespace patina
