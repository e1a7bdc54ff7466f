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

// Joins pieces along their rims.
class RimJoiner {
 public:
  RimJoiner(const std::vector<Vec3>& positions, const std::vector<std::size_t>& faces_of,
            double reach, std::vector<RimEdge>& rims, Forest& forest)
      : positions_(positions), faces_of_(faces_of), reach_(reach), rims_(rims), forest_(forest),
        whole_(faces_of.size()) {
    for (const RimEdge& rim : rims) {
      const Vec3 &a = positions[index(rim.vertices[0])], &b = positions[index(rim.vertices[1])];
      middles_.push_back(0.5 * (a + b));
      lengths_.push_back((b - a).norm());
      roots_.push_back(forest.find(rim.face));
      whole_[index(roots_.back())] += lengths_.back();
    }
  }

  // Marks the rims and returns roots of what is joined. Most pieces fit well: only those that close
  // rims do not join are asked for rims that are farther.
  std::vector<std::int32_t> run() {
    const double mean = std::accumulate(lengths_.begin(), lengths_.end(), 0.0) /
                        static_cast<double>(std::max<std::size_t>(1, lengths_.size()));
    const double far = kNear * reach_;
    mark(NearPoints(middles_, std::clamp(kSeam * mean, kLeastSeam * reach_, far)),
         [](std::size_t, std::size_t) { return true; });
    std::vector<char> left(whole_.size()); // by root
    bool any = false;
    for (const std::int32_t piece : roots_)
      if (!joins(piece)) left[index(piece)] = any = true;
    const NearPoints near(middles_, far);
    if (any)
      mark(near, [&](std::size_t i, std::size_t j) {
        return left[index(roots_[i])] != 0 || left[index(roots_[j])] != 0;
      });
    return join(near);
  }

 private:
  template <typename Asked> void mark(const NearPoints& near, const Asked& asked) {
    near.forPairs([&](std::uint32_t i, std::uint32_t j) {
      if (roots_[i] == roots_[j] || !asked(i, j)) return false;
      rims_[i].joined = rims_[j].joined = true;
      if (!(rims_[i].covered && rims_[j].covered) && isSeam(i, j))
        rims_[i].covered = rims_[j].covered = true;
      return false;
    });
    shared_.assign(whole_.size(), 0);
    for (std::size_t i = 0; i < rims_.size(); ++i)
      if (rims_[i].joined) shared_[index(roots_[i])] += lengths_[i];
  }

  bool isSeam(std::size_t i, std::size_t j) const {
    const double limit =
        std::clamp(kSeam * std::min(lengths_[i], lengths_[j]), kLeastSeam * reach_, kNear * reach_);
    const auto apart = [&](std::size_t end) {
      return (positions_[index(rims_[i].vertices[end])] -
              positions_[index(rims_[j].vertices[1 - end])])
          .squaredNorm();
    };
    return apart(0) <= limit * limit && apart(1) <= limit * limit;
  }

  bool joins(std::int32_t piece) const {
    const double share = faces_of_[index(piece)] < kSmallPiece ? kJoinedSmallRim : kJoinedRim;
    return shared_[index(piece)] >= share * whole_[index(piece)];
  }

  std::vector<std::int32_t> join(const NearPoints& near) {
    for (std::size_t i = 0; i < rims_.size(); ++i) {
      rims_[i].joined &= joins(roots_[i]);
      rims_[i].covered &= rims_[i].joined;
    }
    std::vector<std::int32_t> joined;
    near.forPairs([&](std::uint32_t i, std::uint32_t j) {
      if (!rims_[i].joined || !rims_[j].joined || roots_[i] == roots_[j]) return false;
      if (forest_.join(roots_[i], roots_[j])) joined.push_back(roots_[i]);
      return true; // the rest of the row is near that one
    });
    return joined;
  }

  const std::vector<Vec3>& positions_;
  const std::vector<std::size_t>& faces_of_; // by root, of a piece
  const double reach_;
  std::vector<RimEdge>& rims_;
  Forest& forest_;
  std::vector<Vec3> middles_; // by rim
  std::vector<double> lengths_;
  std::vector<std::int32_t> roots_;
  std::vector<double> whole_, shared_; // by root: length of its rim, and of what is joined of it
};

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
    joined = RimJoiner(mesh.positions, faces_of, reach, found.rims, forest).run();

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
