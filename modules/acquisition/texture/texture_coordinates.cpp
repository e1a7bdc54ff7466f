#include "acquisition/texture/texture_coordinates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace patina {
namespace {

constexpr double kShortestGap = 1e-6; // smallest gap over the mesh's size
constexpr double kRepeated = 1e-9;    // distance of repeated points over the path's size
constexpr double kFlat = 1e-3;        // smallest area ratio of a face that is not degenerate
constexpr double kWindow = 3;         // search window about a face, in its radii

bool shareEdge(const MeshQuery& ground, std::int32_t a, std::int32_t b) {
  const auto& across = ground.neighbours.face_neighbours[static_cast<std::size_t>(a)];
  return std::find(across.begin(), across.end(), b) != across.end();
}

// A path without repeated points. If it is closed, segment numbers continue through the seam:
// segment -1 is the last one, at negative arc length.
class Polyline {
 public:
  explicit Polyline(const PathOnMesh& given) {
    const bool has_arc_length = !given.arc_length.empty();
    if (has_arc_length && given.arc_length.size() != given.points.size())
      throw Error("the path has " + std::to_string(given.points.size()) + " points and " +
                  std::to_string(given.arc_length.size()) + " places along it");
    Box3 box;
    for (const Vec3& p : given.points) box.extend(p);
    const double least = box.isEmpty() ? 0 : kRepeated * box.sizes().norm();
    for (std::size_t i = 0; i < given.points.size(); ++i) {
      if (!points_.empty() && (given.points[i] - points_.back()).norm() <= least) continue;
      points_.push_back(given.points[i]);
      if (has_arc_length) x_.push_back(given.arc_length[i]);
    }
    if (!std::is_sorted(x_.begin(), x_.end())) throw Error("the places along the path fall");
    if (points_.size() < 2) throw Error("the path has no length");
    closed_ = points_.size() > 3 && (points_.back() - points_.front()).norm() <= least;
    along_.push_back(0);
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      const Vec3 step = points_[i + 1] - points_[i];
      along_.push_back(along_.back() + step.norm());
      direction_.push_back(step.normalized());
    }
    if (!has_arc_length) x_ = along_;
    for (int i = 0; i <= segments(); ++i) {
      const Vec3 sum = direction(closed_ || i > 0 ? i - 1 : 0) +
                       direction(closed_ || i < segments() ? i : i - 1);
      tangent_.push_back(sum.isZero(1e-9) ? direction(i - 1) // the path reverses
                                          : sum.normalized());
    }
  }

  double length() const { return along_.back(); } // arc length
  int segments() const { return static_cast<int>(direction_.size()); }
  // Returns the segments as triangles without area, for a tree.
  TriangleMesh asMesh() const {
    TriangleMesh mesh;
    mesh.positions = points_;
    for (std::int32_t i = 0; i < segments(); ++i) mesh.triangles.push_back({i, i + 1, i + 1});
    return mesh;
  }
  int segmentAt(double x) const {
    const double rounds = closed_ ? std::floor(x / length()) : 0;
    const auto next = std::upper_bound(along_.begin() + 1, along_.end() - 1, x - rounds * length());
    return static_cast<int>(next - along_.begin()) - 1 + static_cast<int>(rounds) * segments();
  }

  struct Foot {
    double way = 0;                                           // arc length from the beginning [m]
    double x = 0;                                             // texture coordinate there [m]
    Vec3 point = Vec3::Zero();                                // closest point
    Vec3 direction = Vec3::Zero();                            // unit tangent of the path there
    double squared = std::numeric_limits<double>::infinity(); // squared distance
    int segment = 0;
    bool inside = true; // false at a cut end of the searched part
  };
  // Returns the closest point to p on segments [first, last]; an open path continues straight.
  Foot foot(const Vec3& p, int first, int last) const {
    Foot best;
    for (int i = first; i <= last; ++i) {
      const double whole = lengthOf(i);
      double t = (p - point(i)).dot(direction(i));
      const bool before = t < 0 && !isFirst(i), behind = t > whole && !isLast(i);
      if (before) t = 0;
      if (behind) t = whole;
      const Vec3 at = point(i) + t * direction(i);
      const double squared = (p - at).squaredNorm();
      if (!(squared < best.squared)) continue;
      best = {along(i) + t,
              xAt(i, t / whole),
              at,
              direction(i),
              squared,
              i,
              !(before && i == first) && !(behind && i == last)};
    }
    return best;
  }
  // The same with tangents interpolated along each segment, so that x grows evenly outside a bend,
  // where the closest point would rest at a corner of the polyline. Searches the segment of `near`
  // and its neighbours; returns `near` if nothing is found.
  Foot smoothFootPoint(const Vec3& p, const Foot& near) const {
    Foot best = near;
    bool found = false;
    for (int i = near.segment - 1; i <= near.segment + 1; ++i) {
      if (!closed_ && (i < 0 || i >= segments())) continue;
      const double whole = lengthOf(i);
      const Vec3 from = tangent(i), turn = tangent(i + 1) - from, q = p - point(i),
                 e = whole * direction(i);
      // Solves (q - s e) . (from + s turn) = 0, 0 <= s <= 1, or beyond on end segments.
      const double c = q.dot(from), b = q.dot(turn) - e.dot(from), a = -e.dot(turn);
      const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
      const double s = 2 * c / (-b + std::copysign(root, -b)); // the root of a straight segment
      if (b * b < 4 * a * c || !std::isfinite(s)) continue;
      if (s < -kOnEnd || s > 1 + kOnEnd) continue;
      const Vec3 at = point(i) + s * e;
      const double squared = (p - at).squaredNorm();
      if (found && squared >= best.squared) continue;
      found = true;
      best = {along(i) + s * whole, xAt(i, s), at, (from + s * turn).normalized(), squared, i,
              near.inside};
    }
    return best;
  }

 private:
  static constexpr double kOnEnd = 1e-12;
  std::size_t at(int i) const { // index of segment i in the list
    const int n = segments();
    return static_cast<std::size_t>(((i % n) + n) % n);
  }
  bool isFirst(int i) const { return !closed_ && i == 0; }
  bool isLast(int i) const { return !closed_ && i == segments() - 1; }
  const Vec3& point(int i) const { return points_[at(i)]; }
  const Vec3& direction(int i) const { return direction_[at(i)]; }
  const Vec3& tangent(int i) const {
    return tangent_[closed_ ? at(i) : static_cast<std::size_t>(i)];
  }
  double lengthOf(int i) const { return along_[at(i) + 1] - along_[at(i)]; }
  double along(int i) const {
    const auto k = at(i);
    return along_[k] + length() * (i - static_cast<int>(k)) / segments();
  }

  // Returns x at a share of segment i; extrapolates beyond it.
  double xAt(int i, double share) const {
    const auto k = at(i);
    const double whole = x_.back() - x_.front();
    return x_[k] + share * (x_[k + 1] - x_[k]) + whole * (i - static_cast<int>(k)) / segments();
  }

  std::vector<Vec3> points_, direction_, tangent_; // tangents at the points
  std::vector<double> along_, x_; // arc length and texture coordinate of the points
  bool closed_ = false;
};

enum class Verdict { kept, folded, ambiguous, stretched };

struct Judged {
  Verdict verdict = Verdict::kept;
  TexturedFace face;
  double stretch = 0; // along x
};

// Returns the larger singular value of a matrix.
double maxStretchOf(const Eigen::Matrix2d& m) {
  return 0.5 * (std::hypot(m(0, 0) + m(1, 1), m(1, 0) - m(0, 1)) +
                std::hypot(m(0, 0) - m(1, 1), m(1, 0) + m(0, 1)));
}

Judged judge(const MeshQuery& ground, std::int32_t f, const Polyline& path, double nearest,
             double max_stretch) {
  Judged judged;
  judged.face.face = f;
  const auto face = static_cast<std::size_t>(f);
  const std::array<Vec3, 3> corner{ground.mesh.corner(face, 0), ground.mesh.corner(face, 1),
                                   ground.mesh.corner(face, 2)};
  const Vec3 middle = (corner[0] + corner[1] + corner[2]) / 3;
  const Vec3 normal = faceNormal(ground.mesh, face);
  double radius = 0;
  for (const Vec3& c : corner) radius = std::max(radius, (c - middle).norm());
  const int first = path.segmentAt(nearest - kWindow * radius),
            last = path.segmentAt(nearest + kWindow * radius);
  for (std::size_t k = 0; k < 3; ++k) {
    const Polyline::Foot foot = path.smoothFootPoint(corner[k], path.foot(corner[k], first, last));
    if (!foot.inside) judged.verdict = Verdict::ambiguous;
    const Vec3 aside = corner[k] - foot.point;
    const double side = foot.direction.cross(aside).dot(normal);
    judged.face.coords[k] = {foot.x, std::copysign(std::sqrt(foot.squared), side)};
  }
  if (judged.verdict != Verdict::kept) return judged;
  // Map from arc length over the face, in a frame of its plane, to (x, y).
  const Vec3 u = (corner[1] - corner[0]).normalized(), v = normal.cross(u);
  Eigen::Matrix2d way, grown;
  for (int k = 0; k < 2; ++k) {
    const Vec3 edge = corner[static_cast<std::size_t>(k + 1)] - corner[0];
    way.col(k) = Vec2(edge.dot(u), edge.dot(v));
    grown.col(k) = judged.face.coords[static_cast<std::size_t>(k + 1)] - judged.face.coords[0];
  }
  if (!(way.determinant() > 0)) {
    judged.verdict = Verdict::ambiguous; // no area
    return judged;
  }
  const Eigen::Matrix2d map = grown * way.inverse();
  judged.stretch = map.row(0).norm();
  if (!(map.determinant() > kFlat))
    judged.verdict = Verdict::folded;
  else if (maxStretchOf(map) > max_stretch)
    judged.verdict = Verdict::stretched;
  return judged;
}

} // namespace

std::vector<std::int32_t> facesUnder(const MeshQuery& ground, const std::vector<Vec3>& path) {
  const double shortest = kShortestGap * bounds(ground.mesh).sizes().norm();
  std::vector<std::int32_t> faces;
  struct Place {
    Vec3 p;
    std::int32_t face;
  };
  const auto placeOf = [&](const Vec3& p, std::int32_t warm) {
    const std::int32_t face = ground.tree.closestPoint(p, warm).surface.face;
    if (face >= 0) faces.push_back(face);
    return Place{p, face};
  };
  std::vector<std::pair<Place, Place>> open;
  Place last{Vec3::Zero(), -1};
  for (const Vec3& p : path) {
    const Place next = placeOf(p, last.face);
    if (next.face < 0) continue;
    if (last.face >= 0) open.push_back({last, next});
    while (!open.empty()) {
      const auto [a, b] = open.back();
      open.pop_back();
      if (a.face == b.face || shareEdge(ground, a.face, b.face)) continue;
      if ((a.p - b.p).norm() <= shortest) continue;
      const Place middle = placeOf(0.5 * (a.p + b.p), a.face);
      open.push_back({a, middle});
      open.push_back({middle, b});
    }
    last = next;
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

std::vector<std::int32_t> withRings(const MeshQuery& ground, const std::vector<std::int32_t>& faces,
                                    int rings, Neighbours neighbours) {
  const Adjacency& near = ground.neighbours;
  std::vector<char> taken(ground.mesh.triangles.size(), 0);
  std::vector<std::int32_t> all, edge = faces;
  const auto take = [&](std::int32_t face, std::vector<std::int32_t>& into) {
    if (face < 0 || taken[static_cast<std::size_t>(face)]) return;
    taken[static_cast<std::size_t>(face)] = 1;
    into.push_back(face);
  };
  for (const std::int32_t face : edge) take(face, all);
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<std::int32_t> next;
    for (const std::int32_t face : edge) {
      const auto f = static_cast<std::size_t>(face);
      if (neighbours == Neighbours::by_edge) {
        for (const std::int32_t other : near.face_neighbours[f]) take(other, next);
        continue;
      }
      for (const std::int32_t vertex : ground.mesh.triangles[f])
        for (std::int32_t i = near.vertex_offsets[static_cast<std::size_t>(vertex)];
             i < near.vertex_offsets[static_cast<std::size_t>(vertex) + 1]; ++i)
          take(near.vertex_faces[static_cast<std::size_t>(i)], next);
    }
    all.insert(all.end(), next.begin(), next.end());
    edge = std::move(next);
  }
  std::sort(all.begin(), all.end());
  return all;
}

PathCoordinates pathCoordinates(const MeshQuery& ground, const std::vector<std::int32_t>& faces,
                                const PathOnMesh& given, const CoordinateOptions& options) {
  const Polyline path(given);
  const TriangleTree segments(path.asMesh());
  PathCoordinates found;
  found.length = path.length();
  found.min_stretch = std::numeric_limits<double>::infinity();
  std::int32_t warm = -1;
  for (const std::int32_t f : faces) {
    const auto face = static_cast<std::size_t>(f);
    const Vec3 middle =
        (ground.mesh.corner(face, 0) + ground.mesh.corner(face, 1) + ground.mesh.corner(face, 2)) /
        3;
    warm = segments.closestPoint(middle, warm).surface.face;
    const int segment = warm;
    Judged judged =
        judge(ground, f, path, path.foot(middle, segment, segment).way, options.max_stretch);
    judged.face.texture = options.texture;
    switch (judged.verdict) {
    case Verdict::folded:
      ++found.folded;
      break;
    case Verdict::ambiguous:
      ++found.ambiguous;
      break;
    case Verdict::stretched:
      ++found.stretched;
      break;
    case Verdict::kept:
      found.faces.push_back(judged.face);
      found.max_stretch = std::max(found.max_stretch, judged.stretch);
      found.min_stretch = std::min(found.min_stretch, judged.stretch);
    }
  }
  if (found.faces.empty()) found.min_stretch = 0;
  return found;
}

} // namespace patina
