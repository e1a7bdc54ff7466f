#include "authoring/brush/volume_fill.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patina {
namespace {

ClosestPoint closestOn(const TriangleMesh& mesh, std::int32_t face, const Vec3& p) {
  const std::size_t f = index(face);
  const Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2);
  ClosestPoint result;
  result.surface = {face, closestBarycentric(p, a, b, c)};
  const Vec3& w = result.surface.barycentric;
  result.point = w[0] * a + w[1] * b + w[2] * c;
  result.distance = (result.point - p).norm();
  return result;
}

struct Crossing {
  double t = 0; // in units of `way`
  Vec3 barycentric = Vec3::Zero();
};

// Intersects the line through `from` along `way` with a face.
std::optional<Crossing> crossing(const TriangleMesh& mesh, std::int32_t face, const Vec3& from,
                                 const Vec3& way) {
  const std::size_t f = index(face);
  Eigen::Matrix3d sides;
  sides << mesh.corner(f, 1) - mesh.corner(f, 0), mesh.corner(f, 2) - mesh.corner(f, 0), -way;
  const double volume = sides.determinant();
  if (!(std::abs(volume) > 1e-12 * sides.col(0).norm() * sides.col(1).norm() * way.norm()))
    return std::nullopt;
  const Vec3 at = sides.inverse() * (from - mesh.corner(f, 0));
  constexpr double kSlack = 1e-9; // tolerance: an edge belongs to both of its faces
  const double rest = 1 - at[0] - at[1];
  if (!(at[0] >= -kSlack && at[1] >= -kSlack && rest >= -kSlack)) return std::nullopt;
  return Crossing{at[2], Vec3(rest, at[0], at[1])};
}

} // namespace

VolumeFill::VolumeFill(std::shared_ptr<const PaintSurface> surface)
    : surface_(std::move(surface)), face_mark_(surface_->mesh->triangles.size()),
      vertex_mark_(surface_->mesh->positions.size()) {}

std::vector<std::int32_t> VolumeFill::facesOfCell(const Vec3& p) const {
  const SurfaceField& field = *surface_->field;
  std::vector<std::int32_t> faces;
  const Vec3 q = field.grid.toGrid(p);
  for (int axis = 0; axis < 3; ++axis)
    if (!(q[axis] >= -1 && q[axis] <= field.grid.nodes[static_cast<std::size_t>(axis)]))
      return faces;
  for (int corner = 0; corner < 8; ++corner) {
    const std::int32_t face = field.faceAt(static_cast<int>(std::floor(q[0])) + (corner & 1),
                                           static_cast<int>(std::floor(q[1])) + (corner >> 1 & 1),
                                           static_cast<int>(std::floor(q[2])) + (corner >> 2));
    if (face >= 0 && (faces.empty() || face != faces.back())) faces.push_back(face);
  }
  return faces;
}

std::optional<ClosestPoint> VolumeFill::segmentHit(const Vec3& tip, const Vec3& p) const {
  const Vec3 way = p - tip;
  const double length = way.norm();
  if (!(length > 1e-12)) return std::nullopt;
  const double end = 1 + 2 * surface_->field->grid.voxel / length;
  std::optional<ClosestPoint> best;
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::int32_t face : facesOfCell(p)) {
    const std::optional<Crossing> hit = crossing(*surface_->mesh, face, tip, way);
    // Crossings beyond p count only if there are none before it.
    if (!hit || hit->t < 0 || hit->t > end) continue;
    const double rank = hit->t <= 1 ? 1 - hit->t : hit->t;
    if (!(rank < nearest)) continue;
    nearest = rank;
    best = ClosestPoint{};
    best->surface = {face, hit->barycentric};
    best->point = tip + hit->t * way;
    best->distance = (best->point - p).norm();
  }
  return best;
}

std::optional<ClosestPoint> VolumeFill::foot(const Vec3& p) const {
  ClosestPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  const auto consider = [&](std::int32_t face) {
    const ClosestPoint candidate = closestOn(*surface_->mesh, face, p);
    if (candidate.distance < best.distance) best = candidate;
  };
  for (const std::int32_t face : facesOfCell(p)) consider(face);
  if (best.surface.face < 0) return std::nullopt;
  const Adjacency& adjacency = *surface_->adjacency;
  for (std::int32_t from = -1; from != best.surface.face;) {
    from = best.surface.face;
    for (const std::int32_t v : surface_->welded->triangles[index(from)])
      for (std::int32_t k = adjacency.vertex_offsets[index(v)];
           k < adjacency.vertex_offsets[index(v) + 1]; ++k)
        consider(adjacency.vertex_faces[index(k)]);
  }
  return best;
}

std::span<const std::int32_t> VolumeFill::fill(const Vec3& centre, double radius, std::int32_t seed,
                                               const Vec3& front) {
  nextEpoch();
  centre_ = centre;
  front_ = front;
  radius_ = radius;
  found_.clear();
  stack_.clear();
  if (seed >= 0) visit(seed);
  seedFromNodes();
  const Adjacency& adjacency = *surface_->adjacency;
  while (!stack_.empty()) {
    const std::int32_t face = stack_.back();
    stack_.pop_back();
    const std::array<std::int32_t, 3>& neighbours = adjacency.face_neighbours[index(face)];
    for (std::size_t k = 0; k < 3; ++k) {
      if (neighbours[k] >= 0) {
        visit(neighbours[k]);
        continue;
      }
      // Faces around both vertices are visited at a boundary or non-manifold edge.
      const Triangle& triangle = surface_->welded->triangles[index(face)];
      visitFan(triangle[k]);
      visitFan(triangle[(k + 1) % 3]);
    }
  }
  if (surface_->objects.size() > 1) std::sort(found_.begin(), found_.end());
  return found_;
}

void VolumeFill::nextEpoch() {
  if (++epoch_ != 0) return;
  std::fill(face_mark_.begin(), face_mark_.end(), 0);
  std::fill(vertex_mark_.begin(), vertex_mark_.end(), 0);
  epoch_ = 1;
}

void VolumeFill::seedFromNodes() {
  const SurfaceField& field = *surface_->field;
  if (field.face.empty()) return;
  const Vec3 q = field.grid.toGrid(centre_);
  const double r = radius_ / field.grid.voxel;
  std::array<int, 3> low{}, high{}; // nodes, inclusive
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double last = field.grid.nodes[a] - 1;
    if (!(q[axis] + r >= 0 && q[axis] - r <= last)) return;
    low[a] = static_cast<int>(std::ceil(std::max(0.0, q[axis] - r)));
    high[a] = static_cast<int>(std::floor(std::min(last, q[axis] + r)));
    if (low[a] > high[a]) return;
  }
  const auto eachNode = [&](const std::array<int, 3>& block, const FaceBlock& faces) {
    std::int32_t last = -1;
    const auto first = [&](std::size_t a) { return std::max(low[a], kBlockSide * block[a]); };
    const auto end = [&](std::size_t a) {
      return std::min(high[a], kBlockSide * block[a] + kBlockSide - 1);
    };
    for (int k = first(2); k <= end(2); ++k)
      for (int j = first(1); j <= end(1); ++j)
        for (int i = first(0); i <= end(0); ++i) {
          if (!((Vec3(i, j, k) - q).squaredNorm() <= r * r)) continue;
          const std::int32_t face = faces.at(BlockNode::of(Index3{i, j, k}).node);
          if (face >= 0 && face != last) visit(face);
          last = face;
        }
  };
  for (int z = low[2] / kBlockSide; z <= high[2] / kBlockSide; ++z)
    for (int y = low[1] / kBlockSide; y <= high[1] / kBlockSide; ++y)
      for (int x = low[0] / kBlockSide; x <= high[0] / kBlockSide; ++x) {
        const std::int32_t slot = field.slotOf(x, y, z);
        if (slot >= 0) eachNode({x, y, z}, *field.face[index(slot)]);
      }
}

void VolumeFill::visit(std::int32_t face) {
  std::uint32_t& mark = face_mark_[index(face)];
  if (mark == epoch_) return;
  mark = epoch_;
  if (!reaches(face)) return;
  found_.push_back(face);
  stack_.push_back(face);
}

// Visits each vertex once per fill, since a large fan's hub would take quadratic time.
void VolumeFill::visitFan(std::int32_t vertex) {
  std::uint32_t& mark = vertex_mark_[index(vertex)];
  if (mark == epoch_) return;
  mark = epoch_;
  const Adjacency& adjacency = *surface_->adjacency;
  for (std::int32_t k = adjacency.vertex_offsets[index(vertex)];
       k < adjacency.vertex_offsets[index(vertex) + 1]; ++k)
    visit(adjacency.vertex_faces[index(k)]);
}

bool VolumeFill::reaches(std::int32_t face) const {
  const TriangleMesh& mesh = *surface_->mesh;
  const std::size_t f = index(face);
  const Vec3 a = mesh.corner(f, 0) - centre_, b = mesh.corner(f, 1) - centre_,
             c = mesh.corner(f, 2) - centre_;
  if (!front_.isZero(0)) {
    const Vec3 normal = (b - a).cross(c - a);
    if (!(normal.dot(front_) > 0) && !normal.isZero(0)) return false;
  }
  const double r2 = radius_ * radius_;
  if (std::min({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()}) <= r2) return true;
  const Vec3 w = closestBarycentric(Vec3::Zero(), a, b, c);
  return (w[0] * a + w[1] * b + w[2] * c).squaredNorm() <= r2;
}

} // namespace patina
