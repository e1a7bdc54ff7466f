#include "scene/relief_slope.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace patina {
namespace {

// Neighbouring texels that are more of their own steps apart show different places of the surface.
constexpr double kSamePlace = 3;

constexpr double kOnEdge = 1e-9; // barycentric

} // namespace

ReliefSlope::ReliefSlope(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& texels)
    : mesh_(&mesh), uvs_(&uvs), texels_(&texels) {}

ReliefSlope::Face ReliefSlope::faceOf(std::int32_t index) const {
  Face face;
  face.index = index;
  const auto f = static_cast<std::size_t>(index);
  const Vec2 texels(texels_->width, texels_->height);
  std::array<Vec2, 3> at; // [texels], with centres at integers
  for (std::size_t k = 0; k < 3; ++k)
    at[k] = (*uvs_)[f][k].cwiseProduct(texels) - Vec2::Constant(0.5);
  Eigen::Matrix2d sides;
  sides << at[1] - at[0], at[2] - at[0];
  Eigen::Matrix<double, 3, 2> edges;
  edges << mesh_->corner(f, 1) - mesh_->corner(f, 0), mesh_->corner(f, 2) - mesh_->corner(f, 0);
  const Eigen::Matrix2d to_weights = sides.inverse();
  const Eigen::Matrix<double, 3, 2> jacobian = edges * to_weights;
  const Eigen::Matrix2d gram = jacobian.transpose() * jacobian;
  face.gradient_of = jacobian * gram.inverse();
  face.flat = sides.determinant() == 0 || !face.gradient_of.allFinite();
  if (face.flat) return face;
  const Eigen::Vector2d origin = to_weights * -at[0];
  face.first = Vec3(1 - origin.sum(), origin[0], origin[1]);
  face.along_u = Vec3(-to_weights.col(0).sum(), to_weights(0, 0), to_weights(1, 0));
  face.along_v = Vec3(-to_weights.col(1).sum(), to_weights(0, 1), to_weights(1, 1));
  face.step_u = jacobian.col(0).norm();
  face.step_v = jacobian.col(1).norm();
  return face;
}

ReliefSlope::Place ReliefSlope::placeOf(int i, int j, Face& known) const {
  Place place;
  if (i < 0 || j < 0 || i >= texels_->width || j >= texels_->height) return place;
  place.face = texels_->ownerAt(i, j);
  if (place.face < 0) return place;
  if (known.index != place.face) known = faceOf(place.face);
  if (!known.flat) {
    place.barycentric = known.first + i * known.along_u + j * known.along_v;
    place.covered = place.barycentric.minCoeff() > -kOnEdge;
  }
  if (!place.covered)
    place.barycentric = texelBarycentric((*uvs_)[static_cast<std::size_t>(place.face)],
                                         (i + 0.5) / texels_->width, (j + 0.5) / texels_->height);
  return place;
}

Vec3 ReliefSlope::point(const Place& place) const {
  return position(*mesh_, {place.face, place.barycentric});
}

ReliefSlope::Slope ReliefSlope::inside(const TiledImage& g, int i, int j, const Place& place,
                                       const Face& face) const {
  const double value = static_cast<double>(g.at(i, j, 0));
  Vec2 slope = Vec2::Zero(); // per texel
  bool whole = true;
  Face other;
  for (int axis = 0; axis < 2; ++axis) {
    const double step = axis == 0 ? face.step_u : face.step_v;
    double difference = 0;
    int sides = 0;
    for (const int to : {-1, 1}) {
      const int ni = axis == 0 ? i + to : i, nj = axis == 0 ? j : j + to;
      if (ni < 0 || nj < 0 || ni >= texels_->width || nj >= texels_->height) continue;
      if (texels_->ownerAt(ni, nj) == place.face) {
        const Vec3 beside = place.barycentric + to * (axis == 0 ? face.along_u : face.along_v);
        if (beside.minCoeff() <= -kOnEdge) continue;
      } else {
        const Place beside = placeOf(ni, nj, other);
        if (!beside.covered || (point(beside) - point(place)).norm() > kSamePlace * step) continue;
      }
      difference += to * (static_cast<double>(g.at(ni, nj, 0)) - value);
      ++sides;
    }
    if (sides > 0) slope[axis] = difference / sides;
    whole = whole && sides > 0;
  }
  return {face.gradient_of * slope, whole};
}

Vec3 ReliefSlope::at(const TiledImage& g, int i, int j) const {
  const Place place = placeOf(i, j, last_);
  if (place.face < 0) return Vec3::Zero();
  Slope best;
  if (place.covered) best = inside(g, i, j, place, last_);
  if (best.whole) return best.gradient;
  const Vec3 here = point(place);
  constexpr int kFar = kSlopeReach - 1;
  int nearest = 2 * kSlopeReach * kSlopeReach;
  Face known;
  for (int dj = -kFar; dj <= kFar; ++dj)
    for (int di = -kFar; di <= kFar; ++di) {
      const int distance = di * di + dj * dj;
      if (distance >= nearest) continue;
      const Place beside = placeOf(i + di, j + dj, known);
      if (!beside.covered) continue;
      const double step = std::max(known.step_u, known.step_v);
      if (beside.face != place.face &&
          (point(beside) - here).norm() > kSamePlace * std::sqrt(distance) * step)
        continue;
      const Slope slope = inside(g, i + di, j + dj, beside, known);
      if (!slope.whole) continue;
      nearest = distance;
      best = slope;
    }
  return best.gradient;
}

std::array<unsigned char, 3> encodedSlope(const Vec3& slope) {
  std::array<unsigned char, 3> bytes{};
  for (int axis = 0; axis < 3; ++axis) {
    const double share = std::min(1.0, std::abs(slope[axis]) / kMaxEncodedSlope);
    bytes[static_cast<std::size_t>(axis)] = static_cast<unsigned char>(
        std::lround(128 + 127 * std::copysign(std::sqrt(share), slope[axis])));
  }
  return bytes;
}

} // namespace patina
