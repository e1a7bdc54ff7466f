#include "scene/surface_pick.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "field/store/node_reader.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

// Trilinear, in voxels; an unstored node counts as the band, which its phi exceeds.
double phiAtGrid(const NodeReader& nodes, const Vec3& q) {
  const SurfaceField& field = nodes.field();
  std::array<int, 3> cell{};
  Vec3 w;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    cell[a] = static_cast<int>(
        std::clamp(std::floor(q[axis]), 0.0, static_cast<double>(field.grid.nodes[a] - 2)));
    w[axis] = std::clamp(q[axis] - cell[a], 0.0, 1.0);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1, y = (corner >> 1) & 1, z = corner >> 2;
    const double weight = (x ? w[0] : 1 - w[0]) * (y ? w[1] : 1 - w[1]) * (z ? w[2] : 1 - w[2]);
    const double phi = nodes.phiAt(cell[0] + x, cell[1] + y, cell[2] + z);
    sum += weight * std::clamp(phi, -field.band, field.band);
  }
  return sum;
}

// Part of the ray inside the grid [voxels from its origin]; nullopt if it misses the grid.
std::optional<std::pair<double, double>> rangeInGrid(const SurfaceField& field, const Vec3& origin,
                                                     const Vec3& direction) {
  const Vec3 start = field.grid.toGrid(origin);
  if (!start.allFinite() || !direction.allFinite()) return std::nullopt;
  double from = 0, to = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double last = field.grid.nodes[static_cast<std::size_t>(axis)] - 1;
    if (std::abs(direction[axis]) < 1e-12) {
      if (start[axis] < 0 || start[axis] > last) return std::nullopt;
      continue;
    }
    const double a = -start[axis] / direction[axis], b = (last - start[axis]) / direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (from > to) return std::nullopt;
  return std::pair(from, to);
}

// First point of the ray at which phi crosses `iso` [voxels], to a hundredth of a voxel.
std::optional<Vec3> crossing(const NodeReader& nodes, const Vec3& start, const Vec3& direction,
                             const std::pair<double, double>& range, double iso) {
  const auto excess = [&](double t) { return phiAtGrid(nodes, start + t * direction) - iso; };
  const bool begins_within = excess(range.first) <= 0;
  double previous = range.first;
  for (double t = range.first; t <= range.second;) {
    const double here = excess(t);
    if ((here <= 0) != begins_within) {
      double before = previous, after = t;
      while (after - before > 0.01) {
        const double middle = 0.5 * (before + after);
        ((excess(middle) <= 0) == begins_within ? before : after) = middle;
      }
      return nodes.field().grid.toWorld(start + before * direction);
    }
    previous = t;
    t += std::max(0.25, 0.9 * std::abs(here));
  }
  return std::nullopt;
}

} // namespace

std::optional<Vec3> firstSurfaceAlong(const SurfaceField& field, const Vec3& origin,
                                      const Vec3& direction) {
  const auto range = rangeInGrid(field, origin, direction);
  if (!range) return std::nullopt;
  const NodeReader nodes(field);
  const Vec3 start = field.grid.toGrid(origin) + range->first * direction;
  if (phiAtGrid(nodes, start) <= 0) return field.grid.toWorld(start);
  return crossing(nodes, field.grid.toGrid(origin), direction, *range, 0);
}

std::optional<Vec3> firstCrossingAlong(const SurfaceField& field, const Vec3& origin,
                                       const Vec3& direction, double level) {
  const auto range = rangeInGrid(field, origin, direction);
  if (!range) return std::nullopt;
  return crossing(NodeReader(field), field.grid.toGrid(origin), direction, *range,
                  level / field.grid.voxel);
}

double distanceAt(const SurfaceField& field, const Vec3& p) {
  return field.grid.voxel * phiAtGrid(NodeReader(field), field.grid.toGrid(p));
}

std::optional<SurfacePoint> surfacePointAt(const SurfaceField& field, const TriangleMesh& mesh,
                                           const Vec3& p) {
  const Vec3 q = field.grid.toGrid(p);
  if (!q.allFinite()) return std::nullopt;
  std::set<std::int32_t> faces;
  std::array<int, 3> low{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    low[a] = static_cast<int>(std::clamp(std::floor(q[axis]), -2.0, field.grid.nodes[a] + 1.0));
  }
  for (int k = -1; k <= 2; ++k)
    for (int j = -1; j <= 2; ++j)
      for (int i = -1; i <= 2; ++i) {
        const std::int32_t face = field.faceAt(low[0] + i, low[1] + j, low[2] + k);
        if (face >= 0 && static_cast<std::size_t>(face) < mesh.triangles.size()) faces.insert(face);
      }
  std::optional<SurfacePoint> best;
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::int32_t face : faces) {
    const auto f = static_cast<std::size_t>(face);
    const SurfacePoint point{
        face, closestBarycentric(p, mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2))};
    const double distance = (position(mesh, point) - p).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      best = point;
    }
  }
  return best;
}

std::optional<ObjectPoint> objectPointOf(const Scene& scene, const SurfacePoint& joint) {
  if (joint.face < 0) return std::nullopt;
  std::int64_t first = 0;
  for (std::size_t object = 0; object < scene.objects.size(); ++object) {
    const auto faces = static_cast<std::int64_t>(scene.objects[object].mesh->triangles.size());
    if (joint.face < first + faces)
      return ObjectPoint{object,
                         {static_cast<std::int32_t>(joint.face - first), joint.barycentric}};
    first += faces;
  }
  return std::nullopt;
}

} // namespace patina
