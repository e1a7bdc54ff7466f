#include "geometry/mesh/holes.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "core/numbers.h"

namespace patina {
namespace {

constexpr std::size_t kMostVertices = 64; // the triangulation takes the cube of their number
constexpr double kFlatHole = 1e-4;        // distance from a plane, of the root of the area

Vec3 meanOf(const std::vector<Vec3>& loop) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : loop) sum += p;
  return sum / static_cast<double>(loop.size());
}

std::vector<Vec3> thinned(const std::vector<Vec3>& loop) {
  if (loop.size() <= kMostVertices) return loop;
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < kMostVertices; ++i)
    some.push_back(loop[i * loop.size() / kMostVertices]);
  return some;
}

// least(i, j): least area between the chord from i to j and the loop's vertices between them.
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

  // Sums area and area times centroid of the triangles.
  void sum(double& area, Vec3& moment) const {
    std::vector<std::array<std::size_t, 2>> chords{{0, n_ - 1}};
    while (!chords.empty()) {
      const auto [i, j] = chords.back();
      chords.pop_back();
      if (j - i < 2) continue;
      const std::size_t k = apex_[i * n_ + j];
      area += areaOf(i, k, j);
      moment += areaOf(i, k, j) * (loop_[i] + loop_[k] + loop_[j]) / 3;
      chords.push_back({i, k});
      chords.push_back({k, j});
    }
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

// Walks along unused edges; where the walk meets itself, the loop that it has closed is cut off.
class Loops {
 public:
  Loops(std::size_t points, const std::vector<std::array<std::int32_t, 2>>& edges)
      : edges_(edges), of_point_(points), used_(edges.size()), place_(points, kNowhere) {
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (const std::int32_t p : edges[e]) of_point_[static_cast<std::size_t>(p)].push_back(e);
  }

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
      if (next == kNowhere) { // a dead end
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
    for (const std::size_t e : of_point_[from]) {
      if (used_[e]) continue;
      used_[e] = true;
      const auto a = static_cast<std::size_t>(edges_[e][0]);
      return a == from ? static_cast<std::size_t>(edges_[e][1]) : a;
    }
    return kNowhere;
  }

  const std::vector<std::array<std::int32_t, 2>>& edges_;
  std::vector<std::vector<std::size_t>> of_point_; // edges
  std::vector<bool> used_;
  std::vector<std::size_t> place_; // by point: on the way
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
  Vec3 moment = Vec3::Zero(); // about the mean
  if (off <= kFlatHole * std::sqrt(across.norm())) {
    hole.area = across.norm();
    for (std::size_t i = 0; i < loop.size(); ++i)
      moment += 0.5 * normal.dot((loop[i] - mean).cross(next(i))) * (loop[i] - mean + next(i)) / 3;
  } else {
    std::vector<Vec3> some = thinned(loop);
    for (Vec3& p : some) p -= mean;
    LeastTriangulation(some).sum(hole.area, moment);
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
                          const std::vector<std::array<std::int32_t, 2>>& edges,
                          double least_area) {
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
    // No loop spans more than the circle of its length (isoperimetric inequality).
    if (round * round < 4 * std::numbers::pi * least_area) return;
    const Hole hole = spanned(loop);
    if (hole.area >= least_area) holes.push_back(hole);
  });
  std::stable_sort(holes.begin(), holes.end(),
                   [](const Hole& a, const Hole& b) { return a.area > b.area; });
  return holes;
}

} // namespace patina
