#include "geometry/mesh/connected_parts.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "geometry/mesh/disjoint_sets.h"
#include "geometry/mesh/edge_uses.h"
#include "geometry/mesh/point_grid.h"

namespace patina {
namespace {

constexpr double kNear = 0.7; // of the reach
// Distance of the ends of two rims that are one seam, of the shorter and at least of the reach.
constexpr double kSeam = 0.4, kLeastSeam = 0.25;
constexpr std::size_t kSmallPiece = 4;                    // faces
constexpr double kJoinedRim = 0.5, kJoinedSmallRim = 0.3; // shares of a rim's length

// Marks the rims that run along those of other pieces and joins such pieces. Returns the roots of
// those joined.
std::vector<std::int32_t> joinAlongRims(const std::vector<Vec3>& positions,
                                        const std::vector<std::size_t>& faces_of, double reach,
                                        std::vector<RimEdge>& rims, DisjointSets& pieces) {
  std::vector<Vec3> middles;
  middles.reserve(rims.size());
  for (const RimEdge& rim : rims)
    middles.push_back(0.5 *
                      (positions[index(rim.vertices[0])] + positions[index(rim.vertices[1])]));
  const double far = kNear * reach;
  const PointGrid grid(middles, far);
  struct Place {
    std::array<std::int32_t, 2> vertices;
    std::int32_t root;          // of its piece
    std::int32_t covering = -1; // the rim that lies along it
    double length;
    bool joined = false;
  };
  const auto squareOf = [&](std::int32_t v, std::int32_t w) {
    return (positions[index(v)] - positions[index(w)]).squaredNorm();
  };
  std::vector<Place> places(rims.size()); // in the grid's order
  std::vector<double> whole(faces_of.size()), shared(faces_of.size());
  for (std::size_t n = 0; n < places.size(); ++n) {
    const RimEdge& rim = rims[grid.point(n)];
    Place& at = places[n];
    at.vertices = rim.vertices;
    at.length = std::sqrt(squareOf(at.vertices[0], at.vertices[1]));
    at.root = pieces.find(rim.face);
    whole[index(at.root)] += at.length;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid.size(), 4096), [&](const auto& part) {
    for (std::size_t n = part.begin(); n < part.end(); ++n) {
      Place& at = places[n];
      grid.forEachNear(n, far, [&](std::size_t m) {
        const Place& other = places[m];
        if (other.root == at.root) return false;
        at.joined = true;
        const double limit =
            std::clamp(kSeam * std::min(at.length, other.length), kLeastSeam * reach, far);
        if (squareOf(at.vertices[0], other.vertices[1]) > limit * limit ||
            squareOf(at.vertices[1], other.vertices[0]) > limit * limit)
          return false;
        at.covering = static_cast<std::int32_t>(m);
        return true;
      });
    }
  });
  for (const Place& at : places)
    if (at.joined) shared[index(at.root)] += at.length;
  for (std::size_t n = 0; n < places.size(); ++n) {
    Place& at = places[n];
    const std::size_t piece = index(at.root);
    const double share = faces_of[piece] < kSmallPiece ? kJoinedSmallRim : kJoinedRim;
    at.joined &= shared[piece] >= share * whole[piece];
    RimEdge& rim = rims[grid.point(n)];
    rim.joined = at.joined;
    rim.covered = at.joined && at.covering >= 0;
  }
  // A rim joins its piece to that of the rim that lies along it, else to all that are near.
  for (std::size_t n = 0; n < places.size(); ++n) {
    const Place& at = places[n];
    if (!at.joined) continue;
    if (at.covering >= 0 && places[index(at.covering)].joined)
      pieces.join(at.root, places[index(at.covering)].root);
    else
      grid.forEachNear(n, far, [&](std::size_t m) {
        const bool asks_too = m > n && places[m].covering < 0;
        if (places[m].joined && !asks_too) pieces.join(at.root, places[m].root);
        return false;
      });
  }
  std::vector<std::int32_t> joined;
  for (const Place& at : places)
    if (pieces.find(at.root) != at.root) joined.push_back(at.root);
  return joined;
}

} // namespace

ConnectedParts connectedParts(const TriangleMesh& mesh, double reach) {
  const std::vector<Triangle>& triangles = mesh.triangles;
  const std::vector<std::int32_t> twin = firstTwins(triangles);
  ConnectedParts found;
  DisjointSets pieces(triangles.size());
  std::vector<std::int32_t> crossed;
  const auto rises = [&](const EdgeUse& use) {
    return triangles[index(use.face)][static_cast<std::size_t>(use.edge)] == use.low;
  };
  const auto runOf = [&](const EdgeUse& use) {
    return rises(use) ? std::array{use.low, use.high} : std::array{use.high, use.low};
  };
  forEachEdge(
      triangles, twin, [](std::size_t) { return true; },
      [&](auto first, auto last) {
        if (last - first == 1) found.rims.push_back({runOf(*first), first->face, first->edge});
        if (last - first == 2 && rises(first[0]) == rises(first[1])) crossed.push_back(first->face);
        for (auto use = first + 1; use != last; ++use) pieces.join(first->face, use->face);
      });
  std::vector<std::int32_t> joined;
  std::vector<std::size_t> faces_of(triangles.size()); // by root
  for (std::size_t f = 0; f < triangles.size(); ++f) ++faces_of[index(pieces.find(twin[f]))];
  if (reach > 0 && !triangles.empty() && faces_of[0] < triangles.size())
    joined = joinAlongRims(mesh.positions, faces_of, reach, found.rims, pieces);

  found.part_of.resize(triangles.size());
  std::vector<std::uint8_t> doubled; // by part
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const std::size_t lowest = index(pieces.find(twin[f]));
    if (lowest == f) {
      found.part_of[f] = static_cast<std::int32_t>(found.parts.size());
      found.parts.emplace_back();
      doubled.push_back(0);
    }
    const std::int32_t part = found.part_of[f] = found.part_of[lowest];
    found.parts[index(part)].faces.push_back(static_cast<std::int32_t>(f));
    doubled[index(part)] |= index(twin[f]) != f;
  }
  const auto partOf = [&](std::int32_t face) -> ConnectedPart& {
    return found.parts[index(found.part_of[index(face)])];
  };
  for (const RimEdge& rim : found.rims) ++partOf(rim.face).rim_edges;
  for (const std::int32_t f : joined) partOf(f).joined = true;
  // Where faces are doubled, which way they run is not known.
  for (const std::int32_t f : crossed) partOf(f).twisted = !doubled[index(found.part_of[index(f)])];
  return found;
}

} // namespace patina
