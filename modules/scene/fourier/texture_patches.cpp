#include "scene/fourier/texture_patches.h"

#include <algorithm>
#include <cmath>

#include "core/percentiles.h"
#include "geometry/mesh/vertex_weld.h"

namespace patina {
namespace {

// Gradient over a triangle of what has these values at its corners.
Vec3 slopeOver(const std::array<Vec3, 3>& corner, const std::array<double, 3>& value) {
  const Vec3 along1 = corner[1] - corner[0], along2 = corner[2] - corner[0];
  const Vec3 normal = along1.cross(along2);
  const double squared = normal.squaredNorm();
  if (!(squared > 0)) return Vec3::Zero();
  return ((value[1] - value[0]) * along2.cross(normal) +
          (value[2] - value[0]) * normal.cross(along1)) /
         squared;
}

constexpr double kAlike = 1e-3; // of the greatest height and slope
// A fade over a face thinner than this part of the usual ones counts as one over so wide a face, so
// that a single sliver does not set the whole scene's lateral coupling.
constexpr double kThin = 0.5;

// Of the steepest way over the face, of coordinates with these slopes: the larger singular value.
double stretchOf(const Vec3& x_slope, const Vec3& y_slope) {
  const double xx = x_slope.squaredNorm(), yy = y_slope.squaredNorm(), xy = x_slope.dot(y_slope);
  return std::sqrt(0.5 * (xx + yy + std::hypot(xx - yy, 2 * xy)));
}

double leastAltitude(const TriangleMesh& mesh, std::size_t f) {
  double longest = 0;
  for (int k = 0; k < 3; ++k)
    longest = std::max(longest, (mesh.corner(f, (k + 1) % 3) - mesh.corner(f, k)).norm());
  const Vec3 a = mesh.corner(f, 0);
  return (mesh.corner(f, 1) - a).cross(mesh.corner(f, 2) - a).norm() / longest;
}

// Vertices in one place have one number: across a seam of the mesh its faces are neighbours.
std::vector<std::int32_t> placesOf(const TriangleMesh& mesh) {
  VertexWeld weld(mesh.positions.size());
  std::vector<std::int32_t> places;
  places.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) places.push_back(weld.index(p));
  return places;
}

} // namespace

// Which corners of the mesh a texture need not fade at: all faces about them have it, and agree on
// its height there and on how that grows.
class TexturePatches::InnerCorners {
 public:
  explicit InnerCorners(std::size_t corners) : seen_(corners), inner_(corners, 1) {}

  void add(std::int32_t vertex, std::int32_t texture, const Vec2& at, const FeltTexture* of) {
    const auto v = static_cast<std::size_t>(vertex);
    if (texture < 0 || (seen_[v].texture >= 0 && seen_[v].texture != texture)) {
      inner_[v] = 0;
      return;
    }
    if (seen_[v].texture < 0) {
      seen_[v] = {texture, at};
      return;
    }
    if (seen_[v].at == at || !inner_[v]) return;
    const TextureValue one = of->at.at(at.x(), at.y()),
                       other = of->at.at(seen_[v].at.x(), seen_[v].at.y());
    if (std::abs(one.height - other.height) > kAlike * of->highest ||
        (one.gradient - other.gradient).norm() > kAlike * of->steepest)
      inner_[v] = 0;
  }
  bool operator[](std::int32_t vertex) const { return inner_[static_cast<std::size_t>(vertex)]; }

 private:
  struct Seen {
    std::int32_t texture = -1;
    Vec2 at = Vec2::Zero();
  };
  std::vector<Seen> seen_;
  std::vector<char> inner_;
};

TexturePatches::TexturePatches(const TriangleMesh& mesh, const LaidTextures& laid) {
  const Box3 box = bounds(mesh);
  if (!box.isEmpty()) middle_ = box.center();
  std::map<std::int32_t, std::int32_t> place;
  for (const auto& [number, texture] : laid.library) {
    place[number] = static_cast<std::int32_t>(textures_.size());
    textures_.push_back(texture);
    patch_textures_.push_back({texture->at.line(), texture.get()});
  }
  std::vector<std::int32_t> texture_of(mesh.triangles.size(), -1);
  std::vector<const TexturedFace*> told(mesh.triangles.size());
  for (const TexturedFace& face : laid.faces)
    if (const auto known = place.find(face.texture); known != place.end()) {
      texture_of[static_cast<std::size_t>(face.face)] = known->second;
      told[static_cast<std::size_t>(face.face)] = &face;
    }
  const std::vector<std::int32_t> place_of = placesOf(mesh);
  InnerCorners inner(mesh.positions.size());
  for (std::size_t f = 0; f < told.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const bool known = texture_of[f] >= 0;
      inner.add(place_of[static_cast<std::size_t>(mesh.triangles[f][k])], texture_of[f],
                known ? told[f]->at[k] : Vec2(0, 0),
                known ? textures_[static_cast<std::size_t>(texture_of[f])].get() : nullptr);
    }
  const auto isInner = [&](std::int32_t vertex) {
    return inner[place_of[static_cast<std::size_t>(vertex)]];
  };
  std::vector<double> altitudes;
  for (const TexturedFace& face : laid.faces)
    altitudes.push_back(leastAltitude(mesh, static_cast<std::size_t>(face.face)));
  const double thin = altitudes.empty() ? 0 : kThin * percentiles(altitudes).p50;
  std::vector<char> has_inner(textures_.size(), 0);
  for (std::size_t f = 0; f < told.size(); ++f)
    for (const std::int32_t vertex : mesh.triangles[f])
      if (texture_of[f] >= 0 && isInner(vertex))
        has_inner[static_cast<std::size_t>(texture_of[f])] = 1;

  patch_of_.assign(mesh.triangles.size(), -1);
  for (const TexturedFace& face : laid.faces) {
    const auto f = static_cast<std::size_t>(face.face);
    if (texture_of[f] < 0) continue;
    const auto texture = static_cast<std::size_t>(texture_of[f]);
    std::array<Vec3, 3> corner;
    std::array<double, 3> x, y, fade;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = mesh.corner(f, static_cast<int>(k)) - middle_;
      x[k] = face.at[k].x();
      y[k] = face.at[k].y();
      fade[k] = isInner(mesh.triangles[f][k]) || !has_inner[texture];
    }
    const FeltTexture& of = *textures_[texture];
    const Vec3 x_slope = slopeOver(corner, x), y_slope = slopeOver(corner, y);
    TexturePatch patch{};
    patch.texture = &patch_textures_[texture];
    for (int a = 0; a < 3; ++a) {
      patch.x[a] = x_slope[a];
      patch.y[a] = y_slope[a];
    }
    patch.x[3] = x[0] - x_slope.dot(corner[0]);
    patch.y[3] = y[0] - y_slope.dot(corner[0]);
    patch.fade = -1;
    const Vec3 fade_slope = slopeOver(corner, fade);
    if (fade[0] + fade[1] + fade[2] < 3) {
      patch.fade = static_cast<std::int32_t>(fades_.size());
      fades_.push_back({fade[0] - fade_slope.dot(corner[0]), fade_slope});
    }
    patch_of_[f] = static_cast<std::int32_t>(patches_.size());
    patches_.push_back(patch);
    highest_ = std::max(highest_, of.highest);
    const double steep = stretchOf(x_slope, y_slope);
    // Of the fade: 1.5 of it, its bend 6 of its square.
    const double ends = std::min(fade_slope.norm(), 1 / thin);
    bend_ = std::max(bend_, of.bend * steep * steep + 3 * of.steepest * steep * ends +
                                6 * of.highest * ends * ends);
    stiffest_ = std::max(stiffest_, of.stiffness);
  }
  table_ = {{middle_.x(), middle_.y(), middle_.z(), -1},
            patch_of_.data(),
            patches_.data(),
            patch_of_.size()};
}

void TexturePatches::read(std::int32_t face, const Vec3& p, PatchAt& found,
                          Eigen::Matrix3d* bend) const noexcept {
  if (bend) bend->setZero();
  if (face < 0 || static_cast<std::size_t>(face) >= patch_of_.size()) return;
  const std::int32_t index = patch_of_[static_cast<std::size_t>(face)];
  if (index < 0) return;
  const TexturePatch& patch = patches_[static_cast<std::size_t>(index)];
  const FeltTexture& texture = *patch.texture->of;
  const Vec3 q = p - middle_, by_x(patch.x), by_y(patch.y);
  const double x = patch.x[3] + by_x.dot(q), y = patch.y[3] + by_y.dot(q);
  const TextureValue h = texture.at.at(x, y);
  if (bend) {
    Eigen::Matrix<double, 3, 2> along;
    along << by_x, by_y;
    *bend = along * bendAt(texture, x, y) * along.transpose();
  }
  found.height = h.height;
  found.setSlope(h.gradient.x() * by_x + h.gradient.y() * by_y);
  take(patch, p, found, bend);
}

void TexturePatches::fadeOut(const TexturePatch& patch, const Vec3& p, PatchAt& found,
                             Eigen::Matrix3d* bend) const noexcept {
  const Fade& fade = fades_[static_cast<std::size_t>(patch.fade)];
  const double w = std::clamp(fade.at + fade.slope.dot(p - middle_), 0.0, 1.0);
  const double share = w * w * (3 - 2 * w), growth = 6 * w * (1 - w);
  found.texture.share = share;
  found.texture.slope = growth * fade.slope;
  const Vec3 slope = found.slope();
  if (bend)
    *bend = share * *bend +
            growth * (slope * fade.slope.transpose() + fade.slope * slope.transpose()) +
            (6 - 12 * w) * found.height * fade.slope * fade.slope.transpose();
  found.setSlope(share * slope + found.height * found.texture.slope);
  found.height *= share;
}

std::size_t TexturePatches::bytes() const {
  std::size_t sum = sizeof *this + patch_textures_.capacity() * sizeof(PatchTexture) +
                    patch_of_.capacity() * sizeof(std::int32_t) +
                    patches_.capacity() * sizeof(TexturePatch) + fades_.capacity() * sizeof(Fade);
  for (const auto& texture : textures_) sum += texture->at.bytes();
  return sum;
}

} // namespace patina
