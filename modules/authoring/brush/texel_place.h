// Where on the surface the texels of one object lie.
#pragma once

#include <vector>

#include "authoring/brush/paint_surface.h"

namespace patina {

struct TexelPlace {
  Vec3 point = Vec3::Zero(); // [m], world
  bool inside = true;        // false: a gutter texel, which shows its face's edge once more
};

// One face of an object, with what a texel of its own needs.
class FaceTexels {
 public:
  // face: in the joint mesh.
  FaceTexels(const PaintSurface& surface, const PaintObject& object, std::int32_t face);

  TexelPlace at(int i, int j) const;
  // Calls visit(i, j) for the texels that the face owns and that may show a place within `radius`
  // of `centre`.
  template <typename Visit>
  void forNear(const Vec3& centre, double radius, const Visit& visit) const {
    const TexelBox box =
        texelsNear(corners_, *uv_, centre, radius, texels_->width, texels_->height);
    for (int j = box.j0; j < box.j1; ++j)
      for (int i = box.i0; i < box.i1; ++i)
        if (texels_->ownerAt(i, j) == local_) visit(i, j);
  }
  Vec3 normal() const; // unit; zero without area
  // No two neighbouring texels of the face's plane are farther apart than this [m].
  double footprint() const;

 private:
  std::array<Vec3, 3> corners_; // world
  const std::array<Vec2, 3>* uv_;
  const TexelMap* texels_;
  std::int32_t local_; // in the object's own mesh
};

} // namespace patina
