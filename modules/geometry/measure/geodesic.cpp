#include "geometry/measure/geodesic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>

#include "geometry/measure/face_strip.h"
#include "geometry/measure/mesh_part.h"
#include "geometry/measure/near_path.h"

namespace patina {
namespace {

// Points on each edge, besides its ends, over which the first path is searched.
constexpr int kEdgePoints = 7;
constexpr std::size_t kPollEach = 1024;    // rounds of a search
constexpr std::size_t kManyFaces = 20'000; // more are searched near a first path only
// Largest lengths of a path over the distance of its ends, tried in turn.
constexpr double kDetours[] = {1.25, 2, 5};

// A* (Hart et al. 1968) over vertices and edge points; straight distance is the lower bound.
class EdgeSearch {
 public:
  EdgeSearch(const TriangleMesh& mesh, const Adjacency& neighbours, const SurfacePoint& to)
      : mesh_(mesh), neighbours_(neighbours), goal_(position(mesh, to)), goal_face_(to.face) {}

  // Returns the faces that the path crosses, as found; consecutive ones share an edge or a vertex.
  std::vector<std::int32_t> facesFrom(const SurfacePoint& from, const Progress& progress) {
    const Vec3 start = position(mesh_, from);
    if (from.face == goal_face_) return {from.face};
    relaxFace(from.face, -1, start, 0);
    for (std::size_t rounds = 0; !queue_.empty(); ++rounds) {
      if (rounds % kPollEach == 0) progress.throwIfCancelled();
      const auto [estimate, key] = queue_.top();
      queue_.pop();
      Node& node = nodes_.at(key);
      if (node.done) continue;
      node.done = true;
      if (key == kGoal) return facesBackFrom(key);
      const double cost = node.cost;
      for (const std::int32_t face : facesOf(key)) relaxFace(face, key, pointOf(key), cost);
    }
    return {};
  }

 private:
  using Key = std::int64_t; // (3 face + edge) points + i: edge point; -2 - v: vertex
  static constexpr Key kGoal = std::numeric_limits<Key>::max();
  struct Node {
    double cost = std::numeric_limits<double>::infinity();
    Key before = -1;
    std::int32_t face = -1; // crossed from `before` to here
    bool done = false;
  };

  // An edge point has one key for both faces of its edge.
  Key edgeKey(std::int32_t face, int edge, int i) const {
    const auto f = static_cast<std::size_t>(face);
    const std::int32_t other = neighbours_.face_neighbours[f][static_cast<std::size_t>(edge)];
    if (other >= 0 && other < face) {
      const auto o = static_cast<std::size_t>(other);
      const std::int32_t a = mesh_.triangles[f][static_cast<std::size_t>(edge)];
      const std::int32_t b = mesh_.triangles[f][static_cast<std::size_t>((edge + 1) % 3)];
      for (int k = 0; k < 3; ++k) {
        const std::int32_t c = mesh_.triangles[o][static_cast<std::size_t>(k)];
        const std::int32_t d = mesh_.triangles[o][static_cast<std::size_t>((k + 1) % 3)];
        if (c == b && d == a) return (3 * Key{other} + k) * kEdgePoints + (kEdgePoints - 1 - i);
        if (c == a && d == b) return (3 * Key{other} + k) * kEdgePoints + i;
      }
    }
    return (3 * Key{face} + edge) * kEdgePoints + i;
  }
  Vec3 pointOf(Key key) const {
    if (key == kGoal) return goal_;
    if (key < -1) return mesh_.positions[static_cast<std::size_t>(-2 - key)];
    const auto face = static_cast<std::size_t>(key / (3 * kEdgePoints));
    const int edge = static_cast<int>(key / kEdgePoints % 3),
              i = static_cast<int>(key % kEdgePoints);
    const double t = (i + 1.0) / (kEdgePoints + 1);
    return (1 - t) * mesh_.corner(face, edge) + t * mesh_.corner(face, (edge + 1) % 3);
  }
  std::vector<std::int32_t> facesOf(Key key) const {
    if (key < -1) {
      const auto v = static_cast<std::size_t>(-2 - key);
      return {neighbours_.vertex_faces.begin() + neighbours_.vertex_offsets[v],
              neighbours_.vertex_faces.begin() + neighbours_.vertex_offsets[v + 1]};
    }
    const auto face = static_cast<std::int32_t>(key / (3 * kEdgePoints));
    const std::int32_t other =
        neighbours_.face_neighbours[static_cast<std::size_t>(face)]
                                   [static_cast<std::size_t>(key / kEdgePoints % 3)];
    return other >= 0 ? std::vector{face, other} : std::vector{face};
  }
  void relax(Key key, Key before, std::int32_t face, double cost, const Vec3& at) {
    Node& node = nodes_[key];
    if (node.done || cost >= node.cost) return;
    node = {cost, before, face, false};
    queue_.emplace(cost + (at - goal_).norm(), key);
  }
  void relaxFace(std::int32_t face, Key before, const Vec3& from, double cost) {
    const auto f = static_cast<std::size_t>(face);
    for (int edge = 0; edge < 3; ++edge) {
      const Key vertex = -2 - Key{mesh_.triangles[f][static_cast<std::size_t>(edge)]};
      const Vec3 corner = mesh_.corner(f, edge);
      relax(vertex, before, face, cost + (corner - from).norm(), corner);
      for (int i = 0; i < kEdgePoints; ++i) {
        const Key key = edgeKey(face, edge, i);
        const Vec3 at = pointOf(key);
        relax(key, before, face, cost + (at - from).norm(), at);
      }
    }
    if (face == goal_face_) relax(kGoal, before, face, cost + (goal_ - from).norm(), goal_);
  }
  std::vector<std::int32_t> facesBackFrom(Key key) const {
    std::vector<std::int32_t> faces;
    for (; key != -1; key = nodes_.at(key).before) faces.push_back(nodes_.at(key).face);
    std::reverse(faces.begin(), faces.end());
    return faces;
  }

  const TriangleMesh& mesh_;
  const Adjacency& neighbours_;
  Vec3 goal_;
  std::int32_t goal_face_;
  std::unordered_map<Key, Node> nodes_;
  std::priority_queue<std::pair<double, Key>, std::vector<std::pair<double, Key>>, std::greater<>>
      queue_;
};

std::vector<std::int32_t> crossedFaces(const TriangleMesh& mesh, const Adjacency& neighbours,
                                       const SurfacePoint& from, const SurfacePoint& to,
                                       const Progress& progress) {
  if (mesh.triangles.size() <= kManyFaces)
    return EdgeSearch(mesh, neighbours, to).facesFrom(from, progress);
  const MeshPart part = partOf(mesh, facesNearPath(mesh, neighbours, from, to, progress));
  if (part.face.empty()) return {};
  auto faces = EdgeSearch(part.mesh, adjacency(part.mesh), pointOfPart(part, to))
                   .facesFrom(pointOfPart(part, from), progress);
  for (std::int32_t& face : faces) face = part.face[static_cast<std::size_t>(face)];
  return faces;
}

} // namespace

std::optional<SurfacePath> geodesicPath(const TriangleMesh& mesh, const Adjacency& neighbours,
                                        const SurfacePoint& from, const SurfacePoint& to,
                                        const Progress& progress) {
  const auto found = crossedFaces(mesh, neighbours, from, to, progress);
  if (found.empty()) return std::nullopt;
  const StripWalker walker(mesh, neighbours);
  auto strip = walker.joined(found);
  if (!strip) return std::nullopt;
  const Vec3 start = position(mesh, from), end = position(mesh, to);
  StripPath best = shortestInStrip(mesh, *strip, start, end);
  for (bool shortened = true; shortened;) {
    shortened = false;
    progress.throwIfCancelled();
    for (const StripCorner& corner : best.corners) {
      const auto other = walker.passedOnTheOtherSide(*strip, corner);
      if (!other) continue;
      StripPath path = shortestInStrip(mesh, *other, start, end);
      if (!(path.length < best.length * (1 - 1e-12))) continue;
      strip = other;
      best = std::move(path);
      shortened = true;
      break;
    }
  }
  return SurfacePath{std::move(best.points), best.length};
}

std::optional<SurfacePath> geodesicPath(const TriangleMesh& mesh, const SurfacePoint& from,
                                        const SurfacePoint& to, const Progress& progress) {
  const Vec3 start = position(mesh, from), end = position(mesh, to);
  for (const double detour : kDetours) {
    const double longest = detour * (end - start).norm();
    const MeshPart part = partWithin(mesh, start, end, longest);
    if (part.face.size() == mesh.triangles.size()) break;
    progress.throwIfCancelled();
    auto path = geodesicPath(part.mesh, adjacency(part.mesh), pointOfPart(part, from),
                             pointOfPart(part, to), progress);
    // A shorter path over other faces would lie within the part, too.
    if (path && path->length <= longest) return path;
  }
  progress.throwIfCancelled();
  return geodesicPath(mesh, adjacency(mesh), from, to, progress);
}

} // namespace patina
