#include "geometry/measure/near_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace patina {
namespace {

constexpr int kRings = 4;
constexpr std::size_t kMarchedPerPoll = 4096; // vertices between checks for a cancel

class MarchingFront {
 public:
  MarchingFront(const TriangleMesh& mesh, const Adjacency& neighbours, const SurfacePoint& source)
      : mesh_(mesh), neighbours_(neighbours),
        distance_(mesh.positions.size(), std::numeric_limits<double>::infinity()),
        before_(mesh.positions.size(), -1) {
    const Vec3 start = position(mesh, source);
    for (const std::int32_t v : corners(source.face)) lower(v, (at(v) - start).norm(), -1);
  }

  // Marches until it has passed the corners of the face. Returns false if it does not reach them.
  bool reaches(std::int32_t face, const Progress& progress) {
    const auto farthest = [&] {
      double most = 0;
      for (const std::int32_t v : corners(face)) most = std::max(most, distance(v));
      return most;
    };
    for (std::size_t rounds = 0; !queue_.empty(); ++rounds) {
      if (rounds % kMarchedPerPoll == 0) progress.throwIfCancelled();
      const auto [distance_then, v] = queue_.top();
      if (distance_then > farthest()) return true;
      queue_.pop();
      if (distance_then > distance(v)) continue; // it has a shorter one meanwhile
      for (auto f = neighbours_.vertex_offsets[index(v)];
           f < neighbours_.vertex_offsets[index(v) + 1]; ++f) {
        const Triangle& t = corners(neighbours_.vertex_faces[index(f)]);
        const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
        const std::int32_t p = t[(k + 1) % 3], q = t[(k + 2) % 3];
        update(p, v, q);
        update(q, v, p);
      }
    }
    return std::isfinite(farthest());
  }

  // Returns the vertices from there to the source.
  std::vector<std::int32_t> pathFrom(const SurfacePoint& point) const {
    const Vec3 start = position(mesh_, point);
    const Triangle& t = corners(point.face);
    std::int32_t v = *std::min_element(t.begin(), t.end(), [&](std::int32_t a, std::int32_t b) {
      return distance(a) + (at(a) - start).norm() < distance(b) + (at(b) - start).norm();
    });
    std::vector<std::int32_t> path;
    for (; v >= 0 && path.size() <= before_.size(); v = before_[index(v)]) path.push_back(v);
    return path;
  }

 private:
  static std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }
  const Triangle& corners(std::int32_t face) const { return mesh_.triangles[index(face)]; }
  const Vec3& at(std::int32_t v) const { return mesh_.positions[index(v)]; }
  double distance(std::int32_t v) const { return distance_[index(v)]; }

  void lower(std::int32_t v, double distance, std::int32_t before) {
    if (!(distance < distance_[index(v)] * (1 - 1e-9))) return;
    distance_[index(v)] = distance;
    before_[index(v)] = before;
    queue_.emplace(distance, v);
  }
  // Lowers the distance of c by the way over the edge from a to b.
  void update(std::int32_t c, std::int32_t a, std::int32_t b) {
    const double to_a = (at(c) - at(a)).norm();
    lower(c, distance(a) + to_a, a);
    if (!std::isfinite(distance(b))) return;
    // The face's plane has a at the origin and b on the x axis; c is above, the source below.
    const double length = (at(b) - at(a)).norm();
    if (!(length > 0)) return;
    const double cx = (at(c) - at(a)).dot(at(b) - at(a)) / length;
    const double cy = std::sqrt(std::max(0.0, to_a * to_a - cx * cx));
    const double square_a = distance(a) * distance(a);
    const double sx = (square_a - distance(b) * distance(b) + length * length) / (2 * length);
    const double sy = -std::sqrt(std::max(0.0, square_a - sx * sx));
    if (!(cy - sy > 0)) return;
    const double crosses = sx + (cx - sx) * -sy / (cy - sy);
    if (crosses < 0 || crosses > length) return;
    lower(c, std::hypot(cx - sx, cy - sy), crosses < length / 2 ? a : b);
  }

  const TriangleMesh& mesh_;
  const Adjacency& neighbours_;
  std::vector<double> distance_;
  std::vector<std::int32_t> before_; // next vertex towards the source
  std::priority_queue<std::pair<double, std::int32_t>, std::vector<std::pair<double, std::int32_t>>,
                      std::greater<>>
      queue_;
};

} // namespace

std::vector<std::int32_t> facesNearPath(const TriangleMesh& mesh, const Adjacency& neighbours,
                                        const SurfacePoint& from, const SurfacePoint& to,
                                        const Progress& progress) {
  MarchingFront front(mesh, neighbours, to);
  if (!front.reaches(from.face, progress)) return {};
  std::vector<std::int32_t> rim = front.pathFrom(from);
  std::vector<bool> seen(mesh.positions.size(), false), taken(mesh.triangles.size(), false);
  for (const std::int32_t face : {from.face, to.face}) {
    const Triangle& corners = mesh.triangles[static_cast<std::size_t>(face)];
    rim.insert(rim.end(), corners.begin(), corners.end());
  }
  std::vector<std::int32_t> faces;
  for (int ring = 0; ring < kRings; ++ring) {
    std::vector<std::int32_t> next;
    for (const std::int32_t v : rim) {
      const auto vertex = static_cast<std::size_t>(v);
      if (seen[vertex]) continue;
      seen[vertex] = true;
      for (auto i = neighbours.vertex_offsets[vertex]; i < neighbours.vertex_offsets[vertex + 1];
           ++i) {
        const std::int32_t face = neighbours.vertex_faces[static_cast<std::size_t>(i)];
        if (taken[static_cast<std::size_t>(face)]) continue;
        taken[static_cast<std::size_t>(face)] = true;
        faces.push_back(face);
        const Triangle& corners = mesh.triangles[static_cast<std::size_t>(face)];
        next.insert(next.end(), corners.begin(), corners.end());
      }
    }
    rim = std::move(next);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

} // namespace patina
