#include "haptics/half_spaces.h"

#include <limits>

namespace patina {
namespace {

constexpr double kFeasible = 1e-9;               // voxels
constexpr double kParallel = 1e-9, kFlat = 1e-6; // determinants of pairs and of triples

// All that is needed of the walls about one x: how far each is violated there, and their angles.
struct Problem {
  int count;
  std::array<double, Walls::kMost> violated;
  std::array<std::array<double, Walls::kMost>, Walls::kMost> gram;

  Problem(const Walls& walls, const Vec3& x) noexcept : count(walls.count) {
    for (int i = 0; i < count; ++i) {
      violated[at(i)] = -walls[i].height(x);
      for (int j = 0; j <= i; ++j)
        gram[at(i)][at(j)] = gram[at(j)][at(i)] =
            i == j ? 1.0 : walls[i].normal.dot(walls[j].normal);
    }
  }
  static std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  double g(int i, int j) const noexcept { return gram[at(i)][at(j)]; }
  double v(int i) const noexcept { return violated[at(i)]; }
};

class Search {
 public:
  explicit Search(const Problem& problem) noexcept : p_(problem) {}

  // True if this set of active walls is the answer.
  bool offer(std::array<int, 3> active, std::array<double, 3> load, int count) noexcept {
    for (int k = 0; k < count; ++k)
      if (!(load[Problem::at(k)] >= 0)) return false;
    double worst = 0;
    for (int j = 0; j < p_.count; ++j) {
      double left = p_.v(j);
      for (int k = 0; k < count; ++k)
        left -= load[Problem::at(k)] * p_.g(active[Problem::at(k)], j);
      worst = std::max(worst, left);
    }
    if (worst < least_) {
      least_ = worst;
      best_.active = active;
      best_.load = load;
      best_.count = count;
    }
    return worst <= kFeasible;
  }

  bool singles() noexcept {
    for (int i = p_.count - 1; i >= 0; --i)
      if (offer({i}, {p_.v(i)}, 1)) return true;
    return false;
  }

  bool pairs() noexcept {
    for (int i = p_.count - 1; i >= 0; --i)
      for (int j = i - 1; j >= 0; --j) {
        const double g = p_.g(i, j), det = 1 - g * g;
        if (det < kParallel) continue;
        if (offer({i, j}, {(p_.v(i) - g * p_.v(j)) / det, (p_.v(j) - g * p_.v(i)) / det}, 2))
          return true;
      }
    return false;
  }

  bool triples() noexcept {
    for (int i = p_.count - 1; i >= 0; --i)
      for (int j = i - 1; j >= 0; --j)
        for (int k = j - 1; k >= 0; --k) {
          const double a = p_.g(j, k), b = p_.g(i, k), c = p_.g(i, j);
          // The square of the volume that the three normals span.
          const double det = 1 + 2 * a * b * c - a * a - b * b - c * c;
          if (det < kFlat * kFlat) continue;
          const double u = p_.v(i), v = p_.v(j), w = p_.v(k);
          if (offer({i, j, k},
                    {((1 - a * a) * u + (a * b - c) * v + (a * c - b) * w) / det,
                     ((a * b - c) * u + (1 - b * b) * v + (b * c - a) * w) / det,
                     ((a * c - b) * u + (b * c - a) * v + (1 - c * c) * w) / det},
                    3))
            return true;
        }
    return false;
  }

  const WallProjection& best() const noexcept { return best_; }

 private:
  const Problem& p_;
  WallProjection best_;
  double least_ = std::numeric_limits<double>::infinity();
};

} // namespace

void Walls::remove(int index) noexcept {
  for (int i = index + 1; i < count; ++i) (*this)[i - 1] = (*this)[i];
  --count;
}

void Walls::add(const WallPlane& newest) noexcept {
  if (count == kMost) {
    int farthest = 0;
    double most = -1;
    for (int i = 0; i < count; ++i) {
      const double squared = ((*this)[i].seen - newest.seen).squaredNorm();
      if (squared <= most) continue;
      most = squared;
      farthest = i;
    }
    remove(farthest);
  }
  (*this)[count++] = newest;
}

WallProjection projectOntoWalls(const Walls& walls, const Vec3& x) noexcept {
  WallProjection result;
  result.z = x;
  if (walls.count == 1) {
    const double violated = -walls[0].height(x);
    if (violated <= kFeasible) return result;
    result.z += violated * walls[0].normal;
    result.load[0] = violated;
    result.count = 1;
    return result;
  }
  const Problem problem(walls, x);
  Search search(problem);
  if (!search.offer({}, {}, 0) && !search.singles() && !search.pairs()) search.triples();
  result = search.best();
  result.z = x;
  for (int k = 0; k < result.count; ++k)
    result.z += result.load[Problem::at(k)] * walls[result.active[Problem::at(k)]].normal;
  return result;
}

} // namespace patina
