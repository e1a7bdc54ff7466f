#include "scene/paint/relief_surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "geometry/mesh/adjacency.h"
#include "geometry/tree/triangle_tree.h"
#include "scene/paint/texture_reader.h"

namespace patina {
namespace {

// 72 bytes: a face is on two cache lines at most. Positions are about the mesh's middle, where a
// float is good to 6e-8 of its size, so that nothing depends on where the model lies.
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
                         Vec3::Zero()}; // of no area: nothing is over it
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

constexpr int kMostSteps = 64;
// Steps across edges that bring the point no nearer: half way round a vertex they may be needed.
constexpr int kMostStalls = 8;

} // namespace

class ReliefFaces {
 public:
  Vec3 middle = Vec3::Zero();
  std::vector<PackedFace> faces;
  std::vector<FaceFrame> frames; // where no image is read
  FaceTable table{};             // of them
  std::size_t count = 0;         // of faces
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
  double squared = std::numeric_limits<double>::infinity(); // distance
};

// Of a point above the face; else a weight that is not above 0. Less exact on needles than
// closestBarycentric, from which it takes what is not well within.
Foot footWithin(const PackedFace& face, std::int32_t f, const Vec3& p) noexcept {
  const Vec3 a = face.at(0), r = p - a, along1 = face.at(1) - a, along2 = face.at(2) - a;
  const Vec3 normal = along1.cross(along2);
  const double squared = normal.squaredNorm(), one = r.cross(along2).dot(normal),
               two = along1.cross(r).dot(normal),
               least = static_cast<double>(kWellWithin) * squared;
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

// The face across the edge that the foot lies on, not the one we came from; -1 = the foot is
// within, or nothing is there.
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
  for (int step = 0, stalls = 0; step < kMostSteps && stalls <= kMostStalls; ++step) {
    const std::int32_t next =
        beyond(mesh.faces[static_cast<std::size_t>(at.face)], at.barycentric, from);
    if (next < 0 || (next == best.face && stalls > 1)) break; // once round
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
  int first = 0; // of four texels
  std::array<double, 4> weight{}, slope{}, bend{};
};

Cubic cubicAt(double x) noexcept { // in texels, centres at whole numbers
  const double low = std::floor(x), f = x - low, g = f * f;
  return {static_cast<int>(low) - 1,
          {0.5 * f * ((2 - f) * f - 1), 1 + 0.5 * g * (3 * f - 5), 0.5 * f * (1 + (4 - 3 * f) * f),
           0.5 * g * (f - 1)},
          {0.5 * ((4 - 3 * f) * f - 1), 0.5 * f * (9 * f - 10), 0.5 * (1 + (8 - 9 * f) * f),
           0.5 * f * (3 * f - 2)},
          {2 - 3 * f, 9 * f - 5, 4 - 9 * f, 3 * f - 1}};
}

struct Texels {
  double value = 0, du = 0, dv = 0; // du, dv: over a texel
  double uu = 0, uv = 0, vv = 0;    // second derivatives, only with kBends
};

template <bool kBends> Texels texelsAt(const TiledImage& image, double u, double v) noexcept {
  const int width = image.width(), height = image.height();
  const Cubic x = cubicAt(std::clamp(u, 0.0, 1.0) * width - 0.5);
  const Cubic y = cubicAt(std::clamp(v, 0.0, 1.0) * height - 0.5);
  Texels sum;
  const auto addRow = [&](std::size_t j, const std::array<float, 4>& row) {
    double value = 0, slope = 0, bend = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      value += x.weight[i] * static_cast<double>(row[i]);
      slope += x.slope[i] * static_cast<double>(row[i]);
      if constexpr (kBends) bend += x.bend[i] * static_cast<double>(row[i]);
    }
    sum.value += y.weight[j] * value;
    sum.du += y.weight[j] * slope;
    sum.dv += y.slope[j] * value;
    if constexpr (kBends) {
      sum.uu += y.weight[j] * bend;
      sum.uv += y.slope[j] * slope;
      sum.vv += y.bend[j] * value;
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
               Eigen::Matrix3d* bend) noexcept {
  const Vec2 uv0 = face.uvAt(0), along1 = face.uvAt(1) - uv0, along2 = face.uvAt(2) - uv0;
  const Vec2 uv = uv0 + foot.barycentric[1] * along1 + foot.barycentric[2] * along2;
  const TiledImage& image = *relief.image;
  const Texels g =
      bend ? texelsAt<true>(image, uv.x(), uv.y()) : texelsAt<false>(image, uv.x(), uv.y());
  at.height = relief.height * g.value;
  const Vec2 per_uv(relief.height * g.du * image.width(), relief.height * g.dv * image.height());
  const Vec3 edge1 = face.at(1) - face.at(0), edge2 = face.at(2) - face.at(0);
  const Vec3 normal = edge1.cross(edge2);
  const double squared = normal.squaredNorm();
  // Its change along either edge, by the edges' dual vectors.
  if (squared > 0)
    at.setSlope(
        (per_uv.dot(along1) * edge2.cross(normal) + per_uv.dot(along2) * normal.cross(edge1)) /
        squared);
  if (bend && squared > 0) {
    const Vec3 dual1 = edge2.cross(normal) / squared, dual2 = normal.cross(edge1) / squared;
    const Vec3 of_u = image.width() * (along1.x() * dual1 + along2.x() * dual2);
    const Vec3 of_v = image.height() * (along1.y() * dual1 + along2.y() * dual2);
    *bend = relief.height * (g.uu * of_u * of_u.transpose() + g.vv * of_v * of_v.transpose() +
                             g.uv * (of_u * of_v.transpose() + of_v * of_u.transpose()));
  }
}

} // namespace

void readClosest(const ReliefSurface& relief, const Vec3& c, std::int32_t near_face, ReliefAt& at,
                 Eigen::Matrix3d* bend) noexcept {
  const ReliefFaces& mesh = *relief.faces;
  if (bend) bend->setZero();
  if (static_cast<std::size_t>(near_face) >= mesh.count || !c.allFinite()) return;
  const Foot foot = walk(mesh, c - mesh.middle, near_face);
  at.face = foot.face;
  at.distance = std::sqrt(foot.squared);
  const PackedFace& face = mesh.faces[static_cast<std::size_t>(foot.face)];
  if (relief.image) readImage(relief, face, foot, at, bend);
  if (relief.textures) {
    // Within the face c itself tells where it is, in doubles; beyond an edge the face ends there.
    Vec3 on_face = c;
    if (!(foot.barycentric.minCoeff() > 0))
      on_face = mesh.middle + foot.barycentric[0] * face.at(0) + foot.barycentric[1] * face.at(1) +
                foot.barycentric[2] * face.at(2);
    Eigen::Matrix3d bent;
    const PatchAt patch = relief.textures->at(foot.face, on_face, bend ? &bent : nullptr);
    at.height += patch.height;
    at.setSlope(at.slope() + patch.slope());
    at.texture = patch.texture;
    if (bend) *bend += bent;
  }
}

TextureReader::TextureReader(const ReliefSurface& relief)
    : table_(relief.faces->table), textures_(relief.textures.get()), look_(textureLook()) {
  if (!relief.image && table_.frames && textures_ &&
      relief.faces->count <= textures_->table().faces)
    faces_ = relief.faces->count;
}

ReliefAt reliefAt(const ReliefSurface& relief, const Vec3& c, std::int32_t near_face,
                  Eigen::Matrix3d* bend) noexcept {
  ReliefAt at;
  if (bend || !TextureReader(relief).read(c, near_face, at))
    readClosest(relief, c, near_face, at, bend);
  return at;
}

} // namespace patina
