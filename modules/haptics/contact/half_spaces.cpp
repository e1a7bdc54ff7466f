#include "haptics/contact/half_spaces.h"

#include <algorithm>
#include <limits>

namespace patina {
namespace {

constexpr double kFeasible = 1e-9;               // voxels
constexpr double kParallel = 1e-9, kFlat = 1e-6; // smallest determinants of pairs and of triples
constexpr int kMaxWalls = Walls::kMax;

// Enumerates the active sets for one x; stores the violation of each wall at x and the Gram matrix.
class Search {
 public:
  Search(const Walls& walls, const Vec3& x) noexcept : count_(walls.count) {
    for (int i = 0; i < count_; ++i) {
      violated_[i] = -walls[i].height(x);
      for (int j = 0; j < i; ++j) gram_[i][j] = gram_[j][i] = walls[i].normal.dot(walls[j].normal);
      gram_[i][i] = 1;
    }
  }

  // The solution is the active set with multipliers >= 0 that leaves no wall violated (KKT).
  void run() noexcept {
    if (offer<0>({}, {}) || singles() || pairs()) return;
    triples();
  }
  const WallProjection& best() const noexcept { return best_; }

 private:
  // Keeps the least violating active set; returns true if it is the solution.
  template <int kActive>
  bool offer(const std::array<int, 3>& active, const std::array<double, 3>& load) noexcept {
    double worst = 0;
    for (int j = 0; j < count_; ++j) {
      double left = violated_[j];
      for (int k = 0; k < kActive; ++k)
        left -= load[static_cast<std::size_t>(k)] * gram_[active[static_cast<std::size_t>(k)]][j];
      worst = std::max(worst, left);
    }
    if (worst < least_) {
      least_ = worst;
      best_.active = active;
      best_.multiplier = load;
      best_.count = kActive;
    }
    return worst <= kFeasible;
  }

  bool singles() noexcept {
    for (int i = count_ - 1; i >= 0; --i)
      if (violated_[i] >= 0 && offer<1>({i}, {violated_[i]})) return true;
    return false;
  }

  bool pairs() noexcept {
    for (int i = count_ - 1; i >= 0; --i)
      for (int j = i - 1; j >= 0; --j) {
        const double g = gram_[i][j], u = violated_[i] - g * violated_[j],
                     v = violated_[j] - g * violated_[i], det = 1 - g * g;
        if (!(u >= 0 && v >= 0) || det < kParallel) continue;
        if (offer<2>({i, j}, {u / det, v / det})) return true;
      }
    return false;
  }

  void triples() noexcept {
    for (int i = count_ - 1; i >= 0; --i)
      for (int j = i - 1; j >= 0; --j)
        for (int k = j - 1; k >= 0; --k) {
          const double a = gram_[j][k], b = gram_[i][k], c = gram_[i][j];
          const double u = violated_[i], v = violated_[j], w = violated_[k];
          const double p = (1 - a * a) * u + (a * b - c) * v + (a * c - b) * w,
                       q = (a * b - c) * u + (1 - b * b) * v + (b * c - a) * w,
                       r = (a * c - b) * u + (b * c - a) * v + (1 - c * c) * w;
          // Squared volume that the three normals span.
          const double det = 1 + 2 * a * b * c - a * a - b * b - c * c;
          if (!(p >= 0 && q >= 0 && r >= 0) || det < kFlat * kFlat) continue;
          if (offer<3>({i, j, k}, {p / det, q / det, r / det})) return;
        }
  }

  int count_;
  double violated_[kMaxWalls], gram_[kMaxWalls][kMaxWalls];
  WallProjection best_;
  double least_ = std::numeric_limits<double>::infinity();
};

} // namespace

void Walls::remove(int index) noexcept {
  for (int i = index + 1; i < count; ++i) (*this)[i - 1] = (*this)[i];
  --count;
}

void Walls::add(const WallPlane& newest) noexcept {
  if (count == kMax) {
    int farthest = 0;
    double most = -1;
    for (int i = 0; i < count; ++i) {
      const double squared = ((*this)[i].point - newest.point).squaredNorm();
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
    result.multiplier[0] = violated;
    result.count = 1;
    return result;
  }
  Search search(walls, x);
  search.run();
  result = search.best();
  result.z = x;
  for (int k = 0; k < result.count; ++k)
    result.z += result.multiplier[static_cast<std::size_t>(k)] *
                walls[result.active[static_cast<std::size_t>(k)]].normal;
  return result;
}

} // namespace patina
