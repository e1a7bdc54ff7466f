#include "visualization/relief_slope.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>

namespace patina {
namespace {

// Neighbouring texels farther apart than this many of their own steps are two places.
constexpr double kSamePlace = 3;

using Jacobian = Eigen::Matrix<double, 3, 2>; // d position / d (u, v)

std::optional<Jacobian> jacobianOf(const std::array<Vec3, 3>& corner,
                                   const std::array<Vec2, 3>& uv) {
  Eigen::Matrix2d edges_uv;
  edges_uv << uv[1] - uv[0], uv[2] - uv[0];
  const double det = edges_uv.determinant();
  if (det == 0 || !std::isfinite(1 / det)) return std::nullopt;
  Jacobian edges;
  edges << corner[1] - corner[0], corner[2] - corner[0];
  return Jacobian(edges * edges_uv.inverse());
}

} // namespace

ReliefSlope::ReliefSlope(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& texels)
    : mesh_(&mesh), uvs_(&uvs), texels_(&texels) {}

ReliefSlope::Place ReliefSlope::placeOf(int i, int j) const {
  Place place;
  if (i < 0 || j < 0 || i >= texels_->width || j >= texels_->height) return place;
  place.face = texels_->ownerAt(i, j);
  if (place.face < 0) return place;
  const std::array<Vec2, 3>& uv = (*uvs_)[static_cast<std::size_t>(place.face)];
  const Vec2 centre((i + 0.5) / texels_->width, (j + 0.5) / texels_->height);
  const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0], c = centre - uv[0];
  const double det = a[0] * b[1] - a[1] * b[0];
  const Vec3 raw(0, (c[0] * b[1] - c[1] * b[0]) / det, (a[0] * c[1] - a[1] * c[0]) / det);
  const double first = 1 - raw[1] - raw[2];
  place.covered = std::min({first, raw[1], raw[2]}) > -1e-9;
  place.barycentric =
      place.covered ? Vec3(first, raw[1], raw[2]) : texelBarycentric(uv, centre[0], centre[1]);
  return place;
}

Vec3 ReliefSlope::point(const Place& place) const {
  return position(*mesh_, {place.face, place.barycentric});
}

ReliefSlope::Slope ReliefSlope::inside(const TiledImage& g, int i, int j,
                                       const Place& place) const {
  const auto face = static_cast<std::size_t>(place.face);
  const auto jacobian = jacobianOf(
      {mesh_->corner(face, 0), mesh_->corner(face, 1), mesh_->corner(face, 2)}, (*uvs_)[face]);
  if (!jacobian) return {};
  const Vec3 here = point(place);
  const double value = static_cast<double>(g.at(i, j, 0));
  Vec2 slope = Vec2::Zero(); // along u and v
  bool whole = true;
  for (int axis = 0; axis < 2; ++axis) {
    const int side = axis == 0 ? texels_->width : texels_->height;
    const double step = jacobian->col(axis).norm() / side;
    double difference = 0;
    int sides = 0;
    for (const int to : {-1, 1}) {
      const int ni = axis == 0 ? i + to : i, nj = axis == 0 ? j : j + to;
      const Place beside = placeOf(ni, nj);
      if (!beside.covered) continue;
      if (beside.face != place.face && (point(beside) - here).norm() > kSamePlace * step) continue;
      difference += to * (static_cast<double>(g.at(ni, nj, 0)) - value);
      ++sides;
    }
    if (sides > 0) slope[axis] = difference / sides * side;
    whole = whole && sides > 0;
  }
  const Eigen::Matrix2d gram = jacobian->transpose() * *jacobian;
  const Vec3 gradient = *jacobian * gram.inverse() * slope;
  return {gradient.allFinite() ? gradient : Vec3::Zero(), whole && gradient.allFinite()};
}

Vec3 ReliefSlope::at(const TiledImage& g, int i, int j) const {
  const Place place = placeOf(i, j);
  if (place.face < 0) return Vec3::Zero();
  Slope best;
  if (place.covered) best = inside(g, i, j, place);
  if (best.whole) return best.gradient;
  const Vec3 here = point(place);
  constexpr int kFar = kSlopeReach - 1;
  int nearest = 2 * kSlopeReach * kSlopeReach;
  for (int dj = -kFar; dj <= kFar; ++dj)
    for (int di = -kFar; di <= kFar; ++di) {
      const int distance = di * di + dj * dj;
      if (distance >= nearest) continue;
      const Place beside = placeOf(i + di, j + dj);
      if (!beside.covered) continue;
      const auto face = static_cast<std::size_t>(beside.face);
      const auto jacobian = jacobianOf(
          {mesh_->corner(face, 0), mesh_->corner(face, 1), mesh_->corner(face, 2)}, (*uvs_)[face]);
      if (!jacobian) continue;
      const double step = std::max(jacobian->col(0).norm() / texels_->width,
                                   jacobian->col(1).norm() / texels_->height);
      if (beside.face != place.face &&
          (point(beside) - here).norm() > kSamePlace * std::sqrt(distance) * step)
        continue;
      const Slope slope = inside(g, i + di, j + dj, beside);
      if (!slope.whole) continue;
      nearest = distance;
      best = slope;
    }
  return best.gradient;
}

std::array<unsigned char, 3> encodedSlope(const Vec3& slope) {
  std::array<unsigned char, 3> bytes{};
  for (int axis = 0; axis < 3; ++axis) {
    const double share = std::min(1.0, std::abs(slope[axis]) / kSteepest);
    bytes[static_cast<std::size_t>(axis)] = static_cast<unsigned char>(
        std::lround(128 + 127 * std::copysign(std::sqrt(share), slope[axis])));
  }
  return bytes;
}

} // namespace patina
