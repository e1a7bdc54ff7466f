#include "acquisition/texture/map_texture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.h"
#include "core/percentiles.h"

namespace patina {
namespace {

constexpr double kStepOfEdge = 0.25;
constexpr std::size_t kTurnReach = 8;      // steps: two edges
constexpr double kDistanceTolerance = 0.5; // distance tolerance over a face's edges

double medianEdge(const TriangleMesh& mesh, const std::vector<std::int32_t>& faces) {
  std::vector<double> edges;
  for (const std::int32_t face : faces)
    for (int k = 0; k < 3; ++k)
      edges.push_back((mesh.corner(static_cast<std::size_t>(face), (k + 1) % 3) -
                       mesh.corner(static_cast<std::size_t>(face), k))
                          .norm());
  return percentiles(edges).p50;
}

// Returns the distance of a face's middle from the path.
double distanceOf(const TexturedFace& face) {
  return std::abs(face.coords[0].y() + face.coords[1].y() + face.coords[2].y()) / 3;
}

bool hasLength(const std::vector<Vec3>& points) {
  return std::any_of(points.begin(), points.end(),
                     [&](const Vec3& p) { return p != points.front(); });
}

// Returns the points from `first` to `last`, both included.
PathOnMesh partOf(const PathOnMesh& path, std::size_t first, std::size_t last) {
  const auto from = static_cast<std::ptrdiff_t>(first), to = static_cast<std::ptrdiff_t>(last) + 1;
  PathOnMesh part{{path.points.begin() + from, path.points.begin() + to}, {}};
  if (!path.arc_length.empty())
    part.arc_length.assign(path.arc_length.begin() + from, path.arc_length.begin() + to);
  return part;
}

double meanEdge(const TriangleMesh& mesh, std::int32_t face) {
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    sum += (mesh.corner(static_cast<std::size_t>(face), (k + 1) % 3) -
            mesh.corner(static_cast<std::size_t>(face), k))
               .norm();
  return sum / 3;
}

} // namespace

PathOnMesh resampledUniformly(const PathOnMesh& path, double step) {
  const std::vector<Vec3>& points = path.points;
  if (points.size() < 3) return path;
  PathOnMesh out{{points.front()}, {}};
  const bool has_arc_length = !path.arc_length.empty();
  if (has_arc_length) out.arc_length.push_back(path.arc_length.front());
  Vec3 sum = Vec3::Zero();
  double sum_along = 0, weight = 0, along = 0;
  const auto close = [&] {
    if (!(weight > 0)) return;
    out.points.push_back(sum / weight);
    if (has_arc_length) out.arc_length.push_back(sum_along / weight);
    sum.setZero();
    sum_along = weight = 0;
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 step_on = points[i + 1] - points[i];
    const double length = step_on.norm();
    // Split where a step ends within the segment.
    for (double done = 0; done < length;) {
      const double left = std::min(length - done, step - along),
                   share = (done + 0.5 * left) / length;
      if (!(left > 0)) break;
      sum += left * (points[i] + share * step_on);
      if (has_arc_length)
        sum_along +=
            left * (path.arc_length[i] + share * (path.arc_length[i + 1] - path.arc_length[i]));
      weight += left;
      along += left;
      done += left;
      if (along >= step * (1 - 1e-12)) {
        close();
        along = 0;
      }
    }
  }
  if (along > 0.5 * step) close();
  out.points.push_back(points.back());
  if (has_arc_length) out.arc_length.push_back(path.arc_length.back());
  return out;
}

std::vector<std::size_t> reversalsOf(const std::vector<Vec3>& path, std::size_t reach) {
  std::vector<std::size_t> turns;
  double worst = 0;
  for (std::size_t i = reach; i + reach < path.size(); ++i) {
    const double on = (path[i] - path[i - reach]).dot(path[i + reach] - path[i]);
    if (on >= 0) {
      worst = 0;
      continue;
    }
    if (worst == 0) turns.push_back(i); // one per run of reversing places
    if (on < worst) {
      worst = on;
      turns.back() = i;
    }
  }
  return turns;
}

MappedTexture mapTexture(const MeshQuery& ground, const std::vector<PathOnMesh>& strokes,
                         const LayOptions& options, const Progress& progress) {
  MappedTexture laid;
  std::map<std::int32_t, TexturedFace> fresh; // key: face
  laid.min_stretch = std::numeric_limits<double>::infinity();
  for (const PathOnMesh& stroke : strokes) {
    progress.throwIfCancelled();
    PathOnMesh path = stroke;
    std::int32_t warm = -1;
    for (Vec3& p : path.points) {
      const ClosestPoint near = ground.tree.closestPoint(p, warm);
      warm = near.surface.face;
      if (warm < 0) throw Error("the path has a point that is not finite");
      p = near.point;
      laid.max_distance = std::max(laid.max_distance, near.distance);
    }
    const std::vector<std::int32_t> under = facesUnder(ground, path.points);
    if (under.empty()) continue;
    path = resampledUniformly(path, kStepOfEdge * medianEdge(ground.mesh, under));
    if (!hasLength(path.points)) continue;
    std::vector<std::size_t> ends = reversalsOf(path.points, kTurnReach);
    ends.push_back(path.points.size() - 1);
    double way = 0;
    for (std::size_t first = 0; const std::size_t last : ends) {
      const PathOnMesh leg = partOf(path, first, last);
      first = last;
      const PathCoordinates found = pathCoordinates(
          ground,
          withRings(ground, facesUnder(ground, leg.points), options.rings, options.neighbours), leg,
          {options.texture, options.max_stretch});
      laid.folded += found.folded;
      laid.ambiguous += found.ambiguous;
      laid.stretched += found.stretched;
      laid.max_stretch = std::max(laid.max_stretch, found.max_stretch);
      if (!found.faces.empty()) laid.min_stretch = std::min(laid.min_stretch, found.min_stretch);
      for (TexturedFace face : found.faces) {
        if (leg.arc_length.empty())
          for (Vec2& at : face.coords) at.x() += way;
        const auto [place, is_new] = fresh.try_emplace(face.face, face);
        const double closer = distanceOf(place->second) - distanceOf(face);
        if (!is_new && closer > kDistanceTolerance * meanEdge(ground.mesh, face.face))
          place->second = face;
      }
      way += found.length;
    }
    laid.lengths.push_back(way);
  }
  if (laid.lengths.empty()) throw Error("the path has no length");
  if (fresh.empty()) laid.min_stretch = 0;
  for (const auto& [number, face] : fresh) laid.faces.push_back(face);
  return laid;
}

std::vector<TexturedFace> laidOver(const std::vector<TexturedFace>& above,
                                   const std::vector<TexturedFace>& below) {
  std::vector<TexturedFace> both;
  std::set_union(above.begin(), above.end(), below.begin(), below.end(), std::back_inserter(both),
                 [](const TexturedFace& a, const TexturedFace& b) { return a.face < b.face; });
  return both;
}

} // namespace patina
