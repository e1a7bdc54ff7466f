#include "geometry/mesh/holes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <tbb/parallel_for.h>

#include "core/numbers.h"
#include "geometry/mesh/disjoint_sets.h"
#include "geometry/mesh/edge_uses.h"
#include "geometry/mesh/point_grid.h"

namespace patina {
namespace {

constexpr double kNear = 0.7; // fraction of the reach
// Largest distance between the ends of two matching boundary edges: fractions of the shorter edge
// and, at least, of the reach.
constexpr double kSeam = 0.4, kMinSeam = 0.25;
constexpr std::size_t kSmallPiece = 4;                    // faces
constexpr double kJoinedRim = 0.5, kJoinedSmallRim = 0.3; // fractions of a boundary's length

// Marks boundary edges that match those of other pieces, joins such pieces and returns their former
// roots. `gap` becomes the largest distance across which pieces are joined [m].
std::vector<std::int32_t> joinAlongRims(const std::vector<Vec3>& positions,
                                        const std::vector<std::size_t>& faces_of, double reach,
                                        std::vector<RimEdge>& rims, DisjointSets& pieces,
                                        double& gap) {
  std::vector<Vec3> middles;
  middles.reserve(rims.size());
  for (const RimEdge& rim : rims)
    middles.push_back(0.5 *
                      (positions[index(rim.vertices[0])] + positions[index(rim.vertices[1])]));
  const double far = kNear * reach;
  const PointGrid grid(middles, far);
  struct Place {
    std::array<Vec3, 2> ends;
    std::int32_t root;          // root of its piece
    std::int32_t covering = -1; // matching edge of another piece
    double length;
    bool joined = false;
  };
  // Larger distance between the ends of edges that run in opposite directions.
  const auto squareBetween = [](const Place& a, const Place& b) {
    return std::max((a.ends[0] - b.ends[1]).squaredNorm(), (a.ends[1] - b.ends[0]).squaredNorm());
  };
  std::vector<Place> places(rims.size()); // in the grid's order
  std::vector<double> whole(faces_of.size()), shared(faces_of.size());
  for (std::size_t n = 0; n < places.size(); ++n) {
    const RimEdge& rim = rims[grid.point(n)];
    Place& at = places[n];
    at.ends = {positions[index(rim.vertices[0])], positions[index(rim.vertices[1])]};
    at.length = (at.ends[0] - at.ends[1]).norm();
    at.root = pieces.find(rim.face);
    whole[index(at.root)] += at.length;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid.size(), 4096), [&](const auto& part) {
    for (std::size_t n = part.begin(); n < part.end(); ++n) {
      Place& at = places[n];
      const auto limitOf = [&](double length) {
        return std::clamp(kSeam * length, kMinSeam * reach, far);
      };
      // The middles of matching edges are no farther apart than their ends.
      grid.forEachNear(n, std::min(far, limitOf(at.length) * (1 + 1e-9)), [&](std::size_t m) {
        const Place& other = places[m];
        if (other.root == at.root) return false;
        at.joined = true;
        const double limit = limitOf(std::min(at.length, other.length));
        if (squareBetween(at, other) > limit * limit) return false;
        at.covering = static_cast<std::int32_t>(m);
        return true;
      });
      if (!at.joined)
        grid.forEachNear(n, far, [&](std::size_t m) {
          at.joined = places[m].root != at.root;
          return at.joined;
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
  // Joins the piece to that of the matching edge, or else to all pieces nearby.
  const auto isMatched = [&](const Place& at) {
    return at.covering >= 0 && places[index(at.covering)].joined;
  };
  double square = 0;
  for (std::size_t n = 0; n < places.size(); ++n) {
    const Place& at = places[n];
    if (!at.joined) continue;
    if (isMatched(at)) {
      pieces.join(at.root, places[index(at.covering)].root);
      square = std::max(square, squareBetween(at, places[index(at.covering)]));
      continue;
    }
    square = far * far;
    grid.forEachNear(n, far, [&](std::size_t m) {
      const bool asks_too = m > n && places[m].covering < 0;
      if (places[m].joined && !asks_too) pieces.join(at.root, places[m].root);
      return false;
    });
  }
  gap = std::sqrt(square);
  std::vector<std::int32_t> joined;
  for (const Place& at : places)
    if (pieces.find(at.root) != at.root) joined.push_back(at.root);
  return joined;
}

} // namespace

ConnectedParts connectedParts(const TriangleMesh& mesh, double reach) {
  const std::vector<Triangle>& triangles = mesh.triangles;
  const std::vector<std::int32_t> first_of = firstDuplicates(triangles);
  ConnectedParts found;
  DisjointSets pieces(triangles.size());
  std::vector<std::int32_t> crossed;
  const auto rises = [&](const EdgeUse& use) {
    return triangles[index(use.face)][index(use.edge)] == use.low;
  };
  const auto runOf = [&](const EdgeUse& use) {
    return rises(use) ? std::array{use.low, use.high} : std::array{use.high, use.low};
  };
  forEachEdge(
      triangles, [&](std::size_t f) { return index(first_of[f]) == f; },
      [&](const EdgeUse* first, const EdgeUse* last) {
        if (last - first == 1) found.rims.push_back({runOf(*first), first->face, first->edge});
        if (last - first == 2 && rises(first[0]) == rises(first[1])) crossed.push_back(first->face);
        for (auto use = first + 1; use != last; ++use) pieces.join(first->face, use->face);
      });
  std::vector<std::int32_t> joined;
  std::vector<std::size_t> faces_of(triangles.size()); // count per root
  for (std::size_t f = 0; f < triangles.size(); ++f) ++faces_of[index(pieces.find(first_of[f]))];
  if (reach > 0 && !triangles.empty() && faces_of[0] < triangles.size())
    joined = joinAlongRims(mesh.positions, faces_of, reach, found.rims, pieces, found.gap);

  found.part_of.resize(triangles.size());
  std::vector<std::uint8_t> doubled; // part has duplicate faces
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const std::size_t lowest = index(pieces.find(first_of[f]));
    if (lowest == f) {
      found.part_of[f] = static_cast<std::int32_t>(found.parts.size());
      found.parts.emplace_back();
      doubled.push_back(0);
    }
    const std::int32_t part = found.part_of[f] = found.part_of[lowest];
    found.parts[index(part)].faces.push_back(static_cast<std::int32_t>(f));
    doubled[index(part)] |= index(first_of[f]) != f;
  }
  const auto partOf = [&](std::int32_t face) -> ConnectedPart& {
    return found.parts[index(found.part_of[index(face)])];
  };
  for (const RimEdge& rim : found.rims) ++partOf(rim.face).rim_edges;
  for (const std::int32_t f : joined) partOf(f).joined = true;
  // The orientation of duplicate faces is ambiguous.
  for (const std::int32_t f : crossed) partOf(f).twisted = !doubled[index(found.part_of[index(f)])];
  return found;
}

namespace {

constexpr std::size_t kMaxVertices = 64; // The triangulation is cubic in this.
constexpr double kFlatHole = 1e-4;       // distance from a plane over the root of the area

Vec3 meanOf(const std::vector<Vec3>& loop) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : loop) sum += p;
  return sum / static_cast<double>(loop.size());
}

std::vector<Vec3> thinned(const std::vector<Vec3>& loop) {
  if (loop.size() <= kMaxVertices) return loop;
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < kMaxVertices; ++i)
    some.push_back(loop[i * loop.size() / kMaxVertices]);
  return some;
}

// least(i, j) is the least area between the chord from i to j and the loop's vertices between them.
class LeastTriangulation {
 public:
  explicit LeastTriangulation(const std::vector<Vec3>& loop)
      : loop_(loop), n_(loop.size()), least_(n_ * n_), apex_(n_ * n_) {
    for (std::size_t length = 2; length < n_; ++length)
      for (std::size_t i = 0; i + length < n_; ++i) {
        const std::size_t j = i + length;
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t k = i + 1; k < j; ++k) {
          const double area = least_[i * n_ + k] + least_[k * n_ + j] + areaOf(i, k, j);
          if (area >= best) continue;
          best = area;
          apex_[i * n_ + j] = k;
        }
        least_[i * n_ + j] = best;
      }
  }

  // Sums area and area times centroid of the triangles. Returns the centroid of the largest.
  Vec3 sum(double& area, Vec3& moment) const {
    double largest = 0;
    Vec3 middle = Vec3::Zero();
    std::vector<std::array<std::size_t, 2>> chords{{0, n_ - 1}};
    while (!chords.empty()) {
      const auto [i, j] = chords.back();
      chords.pop_back();
      if (j - i < 2) continue;
      const std::size_t k = apex_[i * n_ + j];
      const double own = areaOf(i, k, j);
      const Vec3 centroid = (loop_[i] + loop_[k] + loop_[j]) / 3;
      area += own;
      moment += own * centroid;
      if (own > largest) {
        largest = own;
        middle = centroid;
      }
      chords.push_back({i, k});
      chords.push_back({k, j});
    }
    return middle;
  }

 private:
  double areaOf(std::size_t i, std::size_t k, std::size_t j) const {
    return 0.5 * (loop_[k] - loop_[i]).cross(loop_[j] - loop_[i]).norm();
  }

  const std::vector<Vec3>& loop_;
  const std::size_t n_;
  std::vector<double> least_;
  std::vector<std::size_t> apex_;
};

// Walks along unused edges. If the walk meets itself, it cuts off the loop that it has closed.
class Loops {
 public:
  Loops(std::size_t points, const std::vector<std::array<std::int32_t, 2>>& edges)
      : edges_(edges), of_point_(points,
                                 [&](const auto& visit) {
                                   for (std::size_t e = 0; e < edges.size(); ++e)
                                     for (const std::int32_t p : edges[e]) visit(p, e);
                                 }),
        used_(edges.size()), place_(points, kNowhere) {}

  template <class Visit> void run(const Visit& visit) {
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (!used_[e]) walk(static_cast<std::size_t>(edges_[e][0]), visit);
  }

 private:
  static constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

  template <class Visit> void walk(std::size_t from, const Visit& visit) {
    std::vector<std::size_t> way{from};
    place_[from] = 0;
    while (!way.empty()) {
      const std::size_t next = step(way.back());
      if (next == kNowhere) { // dead end
        place_[way.back()] = kNowhere;
        way.pop_back();
      } else if (place_[next] == kNowhere) {
        place_[next] = way.size();
        way.push_back(next);
      } else {
        const std::size_t first = place_[next];
        visit(
            std::vector<std::size_t>(way.begin() + static_cast<std::ptrdiff_t>(first), way.end()));
        for (std::size_t i = first + 1; i < way.size(); ++i) place_[way[i]] = kNowhere;
        way.resize(first + 1);
      }
    }
  }

  std::size_t step(std::size_t from) {
    for (const std::size_t e : of_point_.at(from)) {
      if (used_[e]) continue;
      used_[e] = true;
      const auto a = static_cast<std::size_t>(edges_[e][0]);
      return a == from ? static_cast<std::size_t>(edges_[e][1]) : a;
    }
    return kNowhere;
  }

  const std::vector<std::array<std::int32_t, 2>>& edges_;
  ByVertex<std::size_t> of_point_; // edges at each point
  std::vector<bool> used_;
  std::vector<std::size_t> place_; // index of each point in the walk
};

} // namespace

Hole spanned(const std::vector<Vec3>& loop) {
  Hole hole;
  hole.edges = loop.size();
  if (loop.empty()) return hole;
  const Vec3 mean = meanOf(loop);
  const auto next = [&](std::size_t i) { return loop[i + 1 == loop.size() ? 0 : i + 1] - mean; };
  Vec3 across = Vec3::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i) across += 0.5 * (loop[i] - mean).cross(next(i));
  const Vec3 normal = across.normalized();
  double off = 0;
  for (const Vec3& p : loop) off = std::max(off, std::abs(normal.dot(p - mean)));
  Vec3 moment = Vec3::Zero(); // relative to the mean
  std::vector<Vec3> some = thinned(loop);
  for (Vec3& p : some) p -= mean;
  double area = 0;
  hole.on = mean + LeastTriangulation(some).sum(area, moment);
  if (off <= kFlatHole * std::sqrt(across.norm())) {
    hole.area = across.norm();
    moment.setZero();
    for (std::size_t i = 0; i < loop.size(); ++i)
      moment += 0.5 * normal.dot((loop[i] - mean).cross(next(i))) * (loop[i] - mean + next(i)) / 3;
  } else {
    hole.area = area;
  }
  hole.centre = hole.area > 0 ? Vec3(mean + moment / hole.area) : mean;
  return hole;
}

std::string describeHole(const Hole& hole) {
  const Vec3& at = hole.centre;
  return formatArea(hole.area) + " about (" + formatLength(at.x()) + ", " + formatLength(at.y()) +
         ", " + formatLength(at.z()) + ")";
}

std::vector<Hole> holesOf(const std::vector<Vec3>& points,
                          const std::vector<std::array<std::int32_t, 2>>& edges, double min_area) {
  std::vector<Hole> holes;
  std::vector<Vec3> loop;
  Loops(points.size(), edges).run([&](const std::vector<std::size_t>& way) {
    if (way.size() < 3) return;
    loop.clear();
    double round = 0;
    for (const std::size_t p : way) {
      if (!loop.empty()) round += (points[p] - loop.back()).norm();
      loop.push_back(points[p]);
    }
    round += (loop.front() - loop.back()).norm();
    // A loop of this length encloses at most the area of a circle (isoperimetric inequality).
    if (round * round < 4 * std::numbers::pi * min_area) return;
    const Hole hole = spanned(loop);
    if (hole.area >= min_area) holes.push_back(hole);
  });
  std::stable_sort(holes.begin(), holes.end(),
                   [](const Hole& a, const Hole& b) { return a.area > b.area; });
  return holes;
}

} // namespace patina
