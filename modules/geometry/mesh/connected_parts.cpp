#include "geometry/mesh/connected_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/mesh/edge_uses.h"
#include "geometry/mesh/near_points.h"

namespace patina {
namespace {

constexpr double kNear = 0.7; // of the reach
// Distance of the ends of two rims that are one seam, of the shorter and at least of the reach.
constexpr double kSeam = 0.4, kLeastSeam = 0.25;
constexpr std::size_t kSmallPiece = 4;                    // faces
constexpr double kJoinedRim = 0.5, kJoinedSmallRim = 0.3; // shares of a rim's length

// Faces as a forest; the lowest face of a tree is its root.
class Forest {
 public:
  explicit Forest(std::size_t size) : up_(size) { std::iota(up_.begin(), up_.end(), 0); }
  std::int32_t find(std::int32_t f) {
    while (up_[index(f)] != f) f = up_[index(f)] = up_[index(up_[index(f)])];
    return f;
  }
  // Whether they were apart.
  bool join(std::int32_t f, std::int32_t g) {
    const std::int32_t a = find(f), b = find(g);
    up_[index(std::max(a, b))] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::int32_t> up_;
};

// Marks the rims that run along others and joins their pieces. Returns the roots of those joined.
std::vector<std::int32_t> joinAlongRims(const std::vector<Vec3>& positions,
                                        const std::vector<std::size_t>& faces_of, double reach,
                                        std::vector<RimEdge>& rims, Forest& forest) {
  std::vector<Vec3> middles;
  std::vector<std::int32_t> root;
  std::vector<double> whole(faces_of.size()), shared(faces_of.size());
  const auto along = [&](const RimEdge& rim) -> Vec3 {
    return positions[index(rim.vertices[1])] - positions[index(rim.vertices[0])];
  };
  for (const RimEdge& rim : rims) {
    middles.push_back(0.5 *
                      (positions[index(rim.vertices[0])] + positions[index(rim.vertices[1])]));
    root.push_back(forest.find(rim.face));
    whole[index(root.back())] += along(rim).norm();
  }
  const NearPoints near(middles, kNear * reach);
  near.forPairs([&](std::uint32_t i, std::uint32_t j) {
    if (root[i] == root[j]) return false;
    rims[i].joined = rims[j].joined = true;
    if (rims[i].covered && rims[j].covered) return false;
    const double shorter = std::min(along(rims[i]).norm(), along(rims[j]).norm());
    const double limit = std::clamp(kSeam * shorter, kLeastSeam * reach, kNear * reach);
    const auto apart = [&](std::size_t end) {
      return (positions[index(rims[i].vertices[end])] - positions[index(rims[j].vertices[1 - end])])
          .norm();
    };
    if (apart(0) <= limit && apart(1) <= limit) rims[i].covered = rims[j].covered = true;
    return false;
  });
  for (std::size_t i = 0; i < rims.size(); ++i)
    if (rims[i].joined) shared[index(root[i])] += along(rims[i]).norm();
  const auto joins = [&](std::int32_t piece) {
    const double share = faces_of[index(piece)] < kSmallPiece ? kJoinedSmallRim : kJoinedRim;
    return shared[index(piece)] >= share * whole[index(piece)];
  };
  for (std::size_t i = 0; i < rims.size(); ++i) {
    rims[i].joined &= joins(root[i]);
    rims[i].covered &= rims[i].joined;
  }
  std::vector<std::int32_t> joined;
  near.forPairs([&](std::uint32_t i, std::uint32_t j) {
    if (!rims[i].joined || !rims[j].joined || root[i] == root[j]) return false;
    if (forest.join(root[i], root[j])) joined.push_back(root[i]);
    return true; // the rest of the row is near that one
  });
  return joined;
}

} // namespace

ConnectedParts connectedParts(const TriangleMesh& mesh, double reach) {
  const std::vector<Triangle>& triangles = mesh.triangles;
  const std::vector<std::int32_t> twin = firstTwins(triangles);
  ConnectedParts found;
  Forest forest(triangles.size());
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
        for (auto use = first + 1; use != last; ++use) forest.join(first->face, use->face);
      });
  std::vector<std::int32_t> joined;
  std::vector<std::size_t> faces_of(triangles.size()); // by root
  for (std::size_t f = 0; f < triangles.size(); ++f) ++faces_of[index(forest.find(twin[f]))];
  if (reach > 0 && !triangles.empty() && faces_of[0] < triangles.size())
    joined = joinAlongRims(mesh.positions, faces_of, reach, found.rims, forest);

  found.part_of.resize(triangles.size());
  std::vector<std::uint8_t> doubled; // by part
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const std::size_t lowest = index(forest.find(twin[f]));
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
