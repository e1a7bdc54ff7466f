#include "authoring/brush/texel_place.h"

#include <algorithm>
#include <cmath>

namespace patina {

FaceTexels::FaceTexels(const PaintSurface& surface, const PaintObject& object, std::int32_t face)
    : texels_(object.texels.get()), local_(face - object.first_face) {
  for (int k = 0; k < 3; ++k)
    corners_[static_cast<std::size_t>(k)] = surface.mesh->corner(static_cast<std::size_t>(face), k);
  uv_ = &(*object.layout.uvs)[static_cast<std::size_t>(local_)];
}

TexelPlace FaceTexels::at(int i, int j) const {
  const Vec2 centre((i + 0.5) / texels_->width, (j + 0.5) / texels_->height);
  const Vec3 w = texelBarycentric(*uv_, centre.x(), centre.y());
  TexelPlace place;
  place.point = w[0] * corners_[0] + w[1] * corners_[1] + w[2] * corners_[2];
  const Vec2 shown = w[0] * (*uv_)[0] + w[1] * (*uv_)[1] + w[2] * (*uv_)[2];
  place.inside = (shown - centre).cwiseAbs().maxCoeff() < 1e-9;
  return place;
}

Vec3 FaceTexels::normal() const {
  const Vec3 across = (corners_[1] - corners_[0]).cross(corners_[2] - corners_[0]);
  const double length = across.norm();
  return length > 0 ? Vec3(across / length) : Vec3::Zero();
}

double FaceTexels::footprint() const {
  const Vec3 e1 = corners_[1] - corners_[0], e2 = corners_[2] - corners_[0];
  const double longest = std::max({e1.norm(), e2.norm(), (e2 - e1).norm()});
  const Vec2 d1 = (*uv_)[1] - (*uv_)[0], d2 = (*uv_)[2] - (*uv_)[0];
  const double det = d1.x() * d2.y() - d1.y() * d2.x();
  // Along u and v: a texel is a step of 1 / width or 1 / height.
  const Vec3 along_u = (e1 * d2.y() - e2 * d1.y()) / (det * texels_->width);
  const Vec3 along_v = (e2 * d1.x() - e1 * d2.x()) / (det * texels_->height);
  const double step = std::hypot(along_u.norm(), along_v.norm());
  return std::isfinite(step) ? step : longest;
}

} // namespace patina
