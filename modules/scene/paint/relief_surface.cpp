#include "scene/paint/relief_surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/percentiles.h"
#include "geometry/mesh/adjacency.h"
#include "geometry/mesh/vertex_weld.h"
#include "geometry/tree/triangle_tree.h"
#include "scene/paint/texture_reader.h"

namespace patina {
namespace {

// Returns the gradient over a triangle of a value given at its corners.
Vec3 slopeOver(const std::array<Vec3, 3>& corner, const std::array<double, 3>& value) {
  const Vec3 along1 = corner[1] - corner[0], along2 = corner[2] - corner[0];
  const Vec3 normal = along1.cross(along2);
  const double squared = normal.squaredNorm();
  if (!(squared > 0)) return Vec3::Zero();
  return ((value[1] - value[0]) * along2.cross(normal) +
          (value[2] - value[0]) * normal.cross(along1)) /
         squared;
}

constexpr double kAlike = 1e-3; // tolerance relative to the largest height and slope
// Faces thinner than this fraction of the usual ones fade as over a face of that width, so that a
// single sliver does not determine the whole scene's lateral coupling.
constexpr double kThin = 0.5;

// Returns the largest singular value of coordinates with these slopes.
double stretchOf(const Vec3& x_slope, const Vec3& y_slope) {
  const double xx = x_slope.squaredNorm(), yy = y_slope.squaredNorm(), xy = x_slope.dot(y_slope);
  return std::sqrt(0.5 * (xx + yy + std::hypot(xx - yy, 2 * xy)));
}

double minAltitude(const TriangleMesh& mesh, std::size_t f) {
  double longest = 0;
  for (int k = 0; k < 3; ++k)
    longest = std::max(longest, (mesh.corner(f, (k + 1) % 3) - mesh.corner(f, k)).norm());
  const Vec3 a = mesh.corner(f, 0);
  return (mesh.corner(f, 1) - a).cross(mesh.corner(f, 2) - a).norm() / longest;
}

// Gives vertices at equal positions one number, so that faces are neighbours across a seam.
std::vector<std::int32_t> mergedVertices(const TriangleMesh& mesh) {
  VertexWeld weld(mesh.positions.size());
  std::vector<std::int32_t> places;
  places.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) places.push_back(weld.index(p));
  return places;
}

} // namespace

// Corners at which a texture need not fade: all adjacent faces have it, with equal height and
// gradient there.
class TexturePatches::InnerCorners {
 public:
  explicit InnerCorners(std::size_t corners) : seen_(corners), inner_(corners, 1) {}

  void add(std::int32_t vertex, std::int32_t texture, const Vec2& at, const HapticTexture* of) {
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
    const TextureValue one = of->evaluator.at(at.x(), at.y()),
                       other = of->evaluator.at(seen_[v].at.x(), seen_[v].at.y());
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

TexturePatches::TexturePatches(const TriangleMesh& mesh, const TextureMappings& laid) {
  const Box3 box = bounds(mesh);
  if (!box.isEmpty()) middle_ = box.center();
  std::map<std::int32_t, std::int32_t> place;
  for (const auto& [number, texture] : laid.library) {
    place[number] = static_cast<std::int32_t>(textures_.size());
    textures_.push_back(texture);
    patch_textures_.push_back({texture->evaluator.line(), texture.get()});
  }
  std::vector<std::int32_t> texture_of(mesh.triangles.size(), -1);
  std::vector<const TexturedFace*> face_of(mesh.triangles.size());
  for (const TexturedFace& face : laid.faces)
    if (const auto known = place.find(face.texture); known != place.end()) {
      texture_of[static_cast<std::size_t>(face.face)] = known->second;
      face_of[static_cast<std::size_t>(face.face)] = &face;
    }
  const std::vector<std::int32_t> place_of = mergedVertices(mesh);
  InnerCorners inner(mesh.positions.size());
  for (std::size_t f = 0; f < face_of.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const bool known = texture_of[f] >= 0;
      inner.add(place_of[static_cast<std::size_t>(mesh.triangles[f][k])], texture_of[f],
                known ? face_of[f]->coords[k] : Vec2(0, 0),
                known ? textures_[static_cast<std::size_t>(texture_of[f])].get() : nullptr);
    }
  const auto isInner = [&](std::int32_t vertex) {
    return inner[place_of[static_cast<std::size_t>(vertex)]];
  };
  std::vector<double> altitudes;
  for (const TexturedFace& face : laid.faces)
    altitudes.push_back(minAltitude(mesh, static_cast<std::size_t>(face.face)));
  const double thin = altitudes.empty() ? 0 : kThin * percentiles(altitudes).p50;
  std::vector<char> has_inner(textures_.size(), 0);
  for (std::size_t f = 0; f < face_of.size(); ++f)
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
      x[k] = face.coords[k].x();
      y[k] = face.coords[k].y();
      fade[k] = isInner(mesh.triangles[f][k]) || !has_inner[texture];
    }
    const HapticTexture& of = *textures_[texture];
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
    // The fade's slope is at most 1.5 times `ends`, its second derivative 6 times its square.
    const double ends = std::min(fade_slope.norm(), 1 / thin);
    max_curvature_ =
        std::max(max_curvature_, of.max_curvature * steep * steep + 3 * of.steepest * steep * ends +
                                     6 * of.highest * ends * ends);
    stiffest_ = std::max(stiffest_, of.stiffness);
  }
  table_ = {{middle_.x(), middle_.y(), middle_.z(), -1},
            patch_of_.data(),
            patches_.data(),
            patch_of_.size()};
}

void TexturePatches::read(std::int32_t face, const Vec3& p, PatchAt& found,
                          Eigen::Matrix3d* hessian) const noexcept {
  if (hessian) hessian->setZero();
  if (face < 0 || static_cast<std::size_t>(face) >= patch_of_.size()) return;
  const std::int32_t index = patch_of_[static_cast<std::size_t>(face)];
  if (index < 0) return;
  const TexturePatch& patch = patches_[static_cast<std::size_t>(index)];
  const HapticTexture& texture = *patch.texture->texture;
  const Vec3 q = p - middle_, by_x(patch.x), by_y(patch.y);
  const double x = patch.x[3] + by_x.dot(q), y = patch.y[3] + by_y.dot(q);
  const TextureValue h = texture.evaluator.at(x, y);
  if (hessian) {
    Eigen::Matrix<double, 3, 2> along;
    along << by_x, by_y;
    *hessian = along * hessianAt(texture, x, y) * along.transpose();
  }
  found.height = h.height;
  found.setSlope(h.gradient.x() * by_x + h.gradient.y() * by_y);
  take(patch, p, found, hessian);
}

void TexturePatches::fadeOut(const TexturePatch& patch, const Vec3& p, PatchAt& found,
                             Eigen::Matrix3d* hessian) const noexcept {
  const Fade& fade = fades_[static_cast<std::size_t>(patch.fade)];
  const double w = std::clamp(fade.at + fade.slope.dot(p - middle_), 0.0, 1.0);
  const double share = w * w * (3 - 2 * w), growth = 6 * w * (1 - w);
  found.texture.weight = share;
  found.texture.slope = growth * fade.slope;
  const Vec3 slope = found.slope();
  if (hessian)
    *hessian = share * *hessian +
               growth * (slope * fade.slope.transpose() + fade.slope * slope.transpose()) +
               (6 - 12 * w) * found.height * fade.slope * fade.slope.transpose();
  found.setSlope(share * slope + found.height * found.texture.slope);
  found.height *= share;
}

std::size_t TexturePatches::bytes() const {
  std::size_t sum = sizeof *this + patch_textures_.capacity() * sizeof(PatchTexture) +
                    patch_of_.capacity() * sizeof(std::int32_t) +
                    patches_.capacity() * sizeof(TexturePatch) + fades_.capacity() * sizeof(Fade);
  for (const auto& texture : textures_) sum += texture->evaluator.bytes();
  return sum;
}

namespace {

// 72 bytes: at most two cache lines per face. Positions are relative to the mesh's middle, where a
// float is exact to 6e-8 of its size, independent of the model's position.
struct PackedFace {
  std::array<float, 9> corner{};
  std::array<float, 6> uv{};
  std::array<std::int32_t, 3> neighbour{}; // across the edge from corner k to k + 1

  Vec3 at(std::size_t k) const noexcept {
    return {corner[3 * k], corner[3 * k + 1], corner[3 * k + 2]};
  }
  Vec2 uvAt(std::size_t k) const noexcept { return {uv[2 * k], uv[2 * k + 1]}; }
};

FaceFrame frameOf(const PackedFace& face) {
  const Vec3 a = face.at(0), along1 = face.at(1) - a, along2 = face.at(2) - a;
  const Vec3 normal = along1.cross(along2);
  const double squared = normal.squaredNorm();
  FaceFrame frame{};
  std::copy_n(face.corner.begin(), 3, std::begin(frame.corner));
  std::array<Vec3, 3> by{Vec3::Zero(), Vec3::Zero(),
                         Vec3::Zero()}; // without area: no point is above it
  if (squared > 0)
    by = {along2.cross(normal) / squared, normal.cross(along1) / squared,
          normal / std::sqrt(squared)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto part = [&](std::size_t i) {
      return std::bit_cast<std::int32_t>(
          static_cast<float>(by[i][static_cast<Eigen::Index>(axis)]));
    };
    frame.lanes[axis] = Int4{part(0), part(1), part(2), face.neighbour[axis]};
  }
  return frame;
}

constexpr int kMaxSteps = 64;
// Limit of steps without approach, which may be needed half way round a vertex.
constexpr int kMaxStalls = 8;

} // namespace

class ReliefFaces {
 public:
  Vec3 middle = Vec3::Zero();
  std::vector<PackedFace> faces;
  std::vector<FaceFrame> frames; // if no image is read
  FaceTable table{};             // view of frames
  std::size_t count = 0;         // number of faces
};

std::shared_ptr<const ReliefFaces> reliefFaces(const TriangleMesh& mesh, const CornerUvs& uvs) {
  if (!uvs.empty() && uvs.size() != mesh.triangles.size())
    throw std::invalid_argument("reliefFaces: texture coordinates do not fit the mesh");
  auto packed = std::make_shared<ReliefFaces>();
  const Box3 box = bounds(mesh);
  if (!box.isEmpty()) packed->middle = box.center();
  const Adjacency neighbours = adjacency(mesh);
  packed->faces.resize(mesh.triangles.size());
  packed->count = packed->faces.size();
  for (std::size_t f = 0; f < packed->faces.size(); ++f) {
    PackedFace& face = packed->faces[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 corner = mesh.corner(f, static_cast<int>(k)) - packed->middle;
      for (std::size_t a = 0; a < 3; ++a)
        face.corner[3 * k + a] = static_cast<float>(corner[static_cast<Eigen::Index>(a)]);
      if (!uvs.empty()) {
        face.uv[2 * k] = static_cast<float>(uvs[f][k].x());
        face.uv[2 * k + 1] = static_cast<float>(uvs[f][k].y());
      }
      face.neighbour[k] = neighbours.face_neighbours[f][k];
    }
  }
  if (uvs.empty()) {
    packed->frames.reserve(packed->faces.size());
    for (const PackedFace& face : packed->faces) packed->frames.push_back(frameOf(face));
    std::copy_n(packed->middle.data(), 3, std::begin(packed->table.middle));
    packed->table.frames = packed->frames.data();
  }
  return packed;
}

std::size_t bytes(const ReliefFaces& faces) {
  return sizeof faces + faces.faces.capacity() * sizeof(PackedFace) +
         faces.frames.capacity() * sizeof(FaceFrame);
}

namespace {

struct Foot {
  std::int32_t face = -1;
  Vec3 barycentric = Vec3::Zero();
  double squared = std::numeric_limits<double>::infinity(); // squared distance
};

// Returns the foot point of a point well above the face's interior, else face -1. Less exact on
// needles than closestBarycentric, which handles all other points.
Foot footWithin(const PackedFace& face, std::int32_t f, const Vec3& p) noexcept {
  const Vec3 a = face.at(0), r = p - a, along1 = face.at(1) - a, along2 = face.at(2) - a;
  const Vec3 normal = along1.cross(along2);
  const double squared = normal.squaredNorm(), one = r.cross(along2).dot(normal),
               two = along1.cross(r).dot(normal),
               least = static_cast<double>(kInteriorMargin) * squared;
  if (!(one > least && two > least && squared - one - two > least)) return {};
  const double per = 1 / squared, above = r.dot(normal);
  return {f, Vec3((squared - one - two) * per, one * per, two * per), above * above * per};
}

Foot footOn(const ReliefFaces& mesh, std::int32_t f, const Vec3& p) noexcept {
  const PackedFace& face = mesh.faces[static_cast<std::size_t>(f)];
  if (const Foot within = footWithin(face, f, p); within.face >= 0) return within;
  const Vec3 a = face.at(0), b = face.at(1), c = face.at(2);
  Foot foot{f, closestBarycentric(p, a, b, c)};
  const Vec3& w = foot.barycentric;
  foot.squared = (w[0] * a + w[1] * b + w[2] * c - p).squaredNorm();
  return foot;
}

// Returns the face across the edge that holds the foot point, other than `from`; -1 if the foot
// point is inside or the edge has no other face.
std::int32_t beyond(const PackedFace& face, const Vec3& barycentric, std::int32_t from) noexcept {
  std::int32_t next = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int32_t across = face.neighbour[(i + 1) % 3];
    if (barycentric[static_cast<Eigen::Index>(i)] == 0 && across >= 0 && across != from)
      next = across;
  }
  return next;
}

Foot walk(const ReliefFaces& mesh, const Vec3& p, std::int32_t start) noexcept {
  Foot best = footOn(mesh, start, p);
  if (best.barycentric.minCoeff() > 0) return best;
  Foot at = best;
  std::int32_t from = -1;
  for (int step = 0, stalls = 0; step < kMaxSteps && stalls <= kMaxStalls; ++step) {
    const std::int32_t next =
        beyond(mesh.faces[static_cast<std::size_t>(at.face)], at.barycentric, from);
    if (next < 0 || (next == best.face && stalls > 1)) break; // a full turn round a vertex
    from = at.face;
    at = footOn(mesh, next, p);
    if (at.squared < best.squared) {
      best = at;
      stalls = 0;
    } else {
      ++stalls;
    }
  }
  return best;
}

struct Cubic {
  int first = 0; // first of four texels
  std::array<double, 4> weight{}, slope{}, curvature{};
};

Cubic cubicAt(double x) noexcept { // [texels], with centres at integers
  const double low = std::floor(x), f = x - low, g = f * f;
  return {static_cast<int>(low) - 1,
          {0.5 * f * ((2 - f) * f - 1), 1 + 0.5 * g * (3 * f - 5), 0.5 * f * (1 + (4 - 3 * f) * f),
           0.5 * g * (f - 1)},
          {0.5 * ((4 - 3 * f) * f - 1), 0.5 * f * (9 * f - 10), 0.5 * (1 + (8 - 9 * f) * f),
           0.5 * f * (3 * f - 2)},
          {2 - 3 * f, 9 * f - 5, 4 - 9 * f, 3 * f - 1}};
}

struct Texels {
  double value = 0, du = 0, dv = 0; // du, dv: per texel
  double uu = 0, uv = 0, vv = 0;    // second derivatives, only with kCurvature
};

template <bool kCurvature> Texels texelsAt(const TiledImage& image, double u, double v) noexcept {
  const int width = image.width(), height = image.height();
  const Cubic x = cubicAt(std::clamp(u, 0.0, 1.0) * width - 0.5);
  const Cubic y = cubicAt(std::clamp(v, 0.0, 1.0) * height - 0.5);
  Texels sum;
  const auto addRow = [&](std::size_t j, const std::array<float, 4>& row) {
    double value = 0, slope = 0, curvature = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      value += x.weight[i] * static_cast<double>(row[i]);
      slope += x.slope[i] * static_cast<double>(row[i]);
      if constexpr (kCurvature) curvature += x.curvature[i] * static_cast<double>(row[i]);
    }
    sum.value += y.weight[j] * value;
    sum.du += y.weight[j] * slope;
    sum.dv += y.slope[j] * value;
    if constexpr (kCurvature) {
      sum.uu += y.weight[j] * curvature;
      sum.uv += y.slope[j] * slope;
      sum.vv += y.curvature[j] * value;
    }
  };
  const int i = x.first, j = y.first;
  const bool one_tile = i >= 0 && j >= 0 && i + 3 < width && j + 3 < height &&
                        i / kTileSide == (i + 3) / kTileSide &&
                        j / kTileSide == (j + 3) / kTileSide;
  if (one_tile) {
    const float* tile = image.tile(image.tileOf(i, j));
    if (!tile) return sum;
    const float* texel = tile + image.offsetOf(i, j);
    for (std::size_t k = 0; k < 4; ++k, texel += kTileSide)
      addRow(k, {texel[0], texel[1], texel[2], texel[3]});
    return sum;
  }
  for (int k = 0; k < 4; ++k) {
    std::array<float, 4> row{};
    for (int l = 0; l < 4; ++l)
      row[static_cast<std::size_t>(l)] =
          image.at(std::clamp(i + l, 0, width - 1), std::clamp(j + k, 0, height - 1), 0);
    addRow(static_cast<std::size_t>(k), row);
  }
  return sum;
}

void readImage(const ReliefSurface& relief, const PackedFace& face, const Foot& foot, ReliefAt& at,
               Eigen::Matrix3d* hessian) noexcept {
  const Vec2 uv0 = face.uvAt(0), along1 = face.uvAt(1) - uv0, along2 = face.uvAt(2) - uv0;
  const Vec2 uv = uv0 + foot.barycentric[1] * along1 + foot.barycentric[2] * along2;
  const TiledImage& image = *relief.image;
  const Texels g =
      hessian ? texelsAt<true>(image, uv.x(), uv.y()) : texelsAt<false>(image, uv.x(), uv.y());
  at.height = relief.height * g.value;
  const Vec2 per_uv(relief.height * g.du * image.width(), relief.height * g.dv * image.height());
  const Vec3 edge1 = face.at(1) - face.at(0), edge2 = face.at(2) - face.at(0);
  const Vec3 normal = edge1.cross(edge2);
  const double squared = normal.squaredNorm();
  // Gradient from its change along either edge, by the edges' dual vectors.
  if (squared > 0)
    at.setSlope(
        (per_uv.dot(along1) * edge2.cross(normal) + per_uv.dot(along2) * normal.cross(edge1)) /
        squared);
  if (hessian && squared > 0) {
    const Vec3 dual1 = edge2.cross(normal) / squared, dual2 = normal.cross(edge1) / squared;
    const Vec3 of_u = image.width() * (along1.x() * dual1 + along2.x() * dual2);
    const Vec3 of_v = image.height() * (along1.y() * dual1 + along2.y() * dual2);
    *hessian = relief.height * (g.uu * of_u * of_u.transpose() + g.vv * of_v * of_v.transpose() +
                                g.uv * (of_u * of_v.transpose() + of_v * of_u.transpose()));
  }
}

} // namespace

void readClosest(const ReliefSurface& relief, const Vec3& c, std::int32_t near_face, ReliefAt& at,
                 Eigen::Matrix3d* hessian) noexcept {
  const ReliefFaces& mesh = *relief.faces;
  if (hessian) hessian->setZero();
  if (static_cast<std::size_t>(near_face) >= mesh.count || !c.allFinite()) return;
  const Foot foot = walk(mesh, c - mesh.middle, near_face);
  at.face = foot.face;
  at.distance = std::sqrt(foot.squared);
  const PackedFace& face = mesh.faces[static_cast<std::size_t>(foot.face)];
  if (relief.image) readImage(relief, face, foot, at, hessian);
  if (relief.textures) {
    // Inside the face c itself is exact, in doubles; beyond an edge use the edge.
    Vec3 on_face = c;
    if (!(foot.barycentric.minCoeff() > 0))
      on_face = mesh.middle + foot.barycentric[0] * face.at(0) + foot.barycentric[1] * face.at(1) +
                foot.barycentric[2] * face.at(2);
    Eigen::Matrix3d texture_hessian;
    const PatchAt patch =
        relief.textures->at(foot.face, on_face, hessian ? &texture_hessian : nullptr);
    at.height += patch.height;
    at.setSlope(at.slope() + patch.slope());
    at.texture = patch.texture;
    if (hessian) *hessian += texture_hessian;
  }
}

TextureReader::TextureReader(const ReliefSurface& relief)
    : table_(relief.faces->table), textures_(relief.textures.get()), kernel_(textureKernel()) {
  if (!relief.image && table_.frames && textures_ &&
      relief.faces->count <= textures_->table().faces)
    faces_ = relief.faces->count;
}

ReliefAt reliefAt(const ReliefSurface& relief, const Vec3& c, std::int32_t near_face,
                  Eigen::Matrix3d* hessian) noexcept {
  ReliefAt at;
  if (hessian || !TextureReader(relief).read(c, near_face, at))
    readClosest(relief, c, near_face, at, hessian);
  return at;
}

} // namespace patina
