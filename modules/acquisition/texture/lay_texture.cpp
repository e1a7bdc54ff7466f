#include "acquisition/texture/lay_texture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/percentiles.h"

namespace patina {
namespace {

constexpr double kStepOfEdge = 0.25;

double medianEdge(const TriangleMesh& mesh, const std::vector<std::int32_t>& faces) {
  std::vector<double> edges;
  for (const std::int32_t face : faces)
    for (int k = 0; k < 3; ++k)
      edges.push_back((mesh.corner(static_cast<std::size_t>(face), (k + 1) % 3) -
                       mesh.corner(static_cast<std::size_t>(face), k))
                          .norm());
  return percentiles(edges).p50;
}

double squaredDistance(const TexturedFace& face) { // of its middle from the path
  const Vec2 middle = (face.at[0] + face.at[1] + face.at[2]) / 3;
  return middle.y() * middle.y();
}

} // namespace

Stroke3 evened(const Stroke3& path, double step) {
  if (path.size() < 3) return path;
  Stroke3 out = {path.front()};
  Vec3 sum = Vec3::Zero();
  double weight = 0, along = 0;
  const auto close = [&] {
    if (weight > 0) out.push_back(sum / weight);
    sum.setZero();
    weight = 0;
  };
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vec3 &a = path[i], &b = path[i + 1];
    const double length = (b - a).norm();
    // Split where a step ends within the segment.
    for (double done = 0; done < length;) {
      const double left = std::min(length - done, step - along);
      sum += left * (a + (b - a) * ((done + 0.5 * left) / length));
      weight += left;
      along += left;
      done += left;
      if (along >= step * (1 - 1e-12)) {
        close();
        along = 0;
      }
      if (!(left > 0)) break;
    }
  }
  if (along > 0.5 * step) close();
  out.push_back(path.back());
  return out;
}

LaidTexture layTexture(const PathGround& ground, const std::vector<Stroke3>& strokes,
                       const LayOptions& options, const Progress& progress) {
  LaidTexture laid;
  std::vector<TexturedFace> fresh;
  laid.least = std::numeric_limits<double>::infinity();
  for (const Stroke3& stroke : strokes) {
    progress.throwIfCancelled();
    Stroke3 path;
    std::int32_t warm = -1;
    for (const Vec3& p : stroke) {
      const ClosestPoint near = ground.tree.closestPoint(p, warm);
      warm = near.surface.face;
      if (warm < 0) continue;
      path.push_back(near.point);
      laid.farthest = std::max(laid.farthest, near.distance);
    }
    std::vector<std::int32_t> under = facesUnder(ground, path);
    if (under.empty()) continue;
    path = evened(path, kStepOfEdge * medianEdge(ground.mesh, under));
    if (path.size() < 2 || !((path.back() - path.front()).norm() > 0 || path.size() > 2)) continue;
    const PathCoordinates found =
        pathCoordinates(ground, withRings(ground, under, options.rings, options.neighbours), path,
                        {options.texture, options.most_stretch});
    laid.lengths.push_back(found.length);
    laid.folded += found.folded;
    laid.ambiguous += found.ambiguous;
    laid.stretched += found.stretched;
    laid.most = std::max(laid.most, found.most);
    laid.least = std::min(laid.least, found.least);
    fresh.insert(fresh.end(), found.faces.begin(), found.faces.end());
  }
  if (laid.lengths.empty()) throw Error("the path has no length");
  if (fresh.empty()) laid.least = 0;
  std::stable_sort(fresh.begin(), fresh.end(), [](const TexturedFace& a, const TexturedFace& b) {
    return a.face != b.face ? a.face < b.face : squaredDistance(a) < squaredDistance(b);
  });
  const auto same_face = [](const TexturedFace& a, const TexturedFace& b) {
    return a.face == b.face;
  };
  fresh.erase(std::unique(fresh.begin(), fresh.end(), same_face), fresh.end());
  laid.faces = std::move(fresh);
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
