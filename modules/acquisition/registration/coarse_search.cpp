#include "acquisition/registration/coarse_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "acquisition/registration/path_fit.h"
#include "core/decompose.h"

namespace patina {
namespace {

constexpr int kCells = 48;                   // along the grid's longest side
constexpr std::size_t kFew = 24, kMore = 96; // points used at first and at last
constexpr double kSame = 0.05;               // radii of the path; nearer poses are the same

// Signed distances minus the offset at grid nodes, positive in front, with linear interpolation.
class DistanceGrid {
 public:
  DistanceGrid(const SurfaceTarget& target, double margin) {
    const TriangleMesh& mesh = target.mesh();
    const Box3 box = bounds(mesh);
    const Vec3 size = box.sizes() + Vec3::Constant(2 * margin);
    spacing_ = size.maxCoeff() / kCells;
    extent_ = box.sizes().norm();
    origin_ = box.min() - Vec3::Constant(margin);
    constexpr int kBlock = 8;
    Eigen::Array3i blocks;
    for (int k = 0; k < 3; ++k) blocks[k] = static_cast<int>(size[k] / spacing_) / kBlock + 1;
    n_ = blocks * kBlock;
    value_.resize(static_cast<std::size_t>(n_.prod()));
    std::vector<float> distance(kBlock * kBlock * kBlock);
    std::vector<std::int32_t> face(distance.size());
    for (int z = 0; z < n_[2]; z += kBlock)
      for (int y = 0; y < n_[1]; y += kBlock)
        for (int x = 0; x < n_[0]; x += kBlock) {
          const Vec3 corner = origin_ + spacing_ * Vec3(x, y, z);
          target.tree().closestOnLattice(corner, spacing_, kBlock,
                                         std::numeric_limits<double>::infinity(), distance, face);
          for (int i = 0; i < kBlock * kBlock * kBlock; ++i) {
            const Eigen::Array3i at(i % kBlock, i / kBlock % kBlock, i / (kBlock * kBlock));
            const std::size_t f = index(face[static_cast<std::size_t>(i)]);
            const Vec3 p = corner + spacing_ * at.matrix().cast<double>();
            // A wrong sign matters little several cells from the surface.
            const bool behind = (p - mesh.corner(f, 0)).dot(faceNormal(mesh, f)) < 0;
            const double d = spacing_ * static_cast<double>(distance[static_cast<std::size_t>(i)]);
            value_[node(at[0] + x, at[1] + y, at[2] + z)] =
                static_cast<float>((behind ? -d : d) - target.offset());
          }
        }
  }

  double spacing() const { return spacing_; }
  double extent() const { return extent_; } // diagonal of the mesh

  // Returns the distance and its gradient; outside the grid it is extrapolated from the border.
  double at(const Vec3& p, Vec3& gradient) const {
    const Vec3 u = (p - origin_) / spacing_;
    Vec3 inside;
    Eigen::Array3i i;
    for (int k = 0; k < 3; ++k) {
      inside[k] = std::clamp(u[k], 0.0, n_[k] - 1.001);
      i[k] = static_cast<int>(inside[k]);
    }
    const Vec3 t = inside - i.matrix().cast<double>();
    const auto value = [&](int x, int y, int z) {
      return static_cast<double>(value_[node(i[0] + x, i[1] + y, i[2] + z)]);
    };
    std::array<double, 4> along;
    double dx = 0;
    for (int c = 0; c < 4; ++c) {
      const double a = value(0, c % 2, c / 2), b = value(1, c % 2, c / 2);
      along[static_cast<std::size_t>(c)] = a + t[0] * (b - a);
      dx += (c % 2 ? t[1] : 1 - t[1]) * (c / 2 ? t[2] : 1 - t[2]) * (b - a);
    }
    const double low = along[0] + t[1] * (along[1] - along[0]),
                 high = along[2] + t[1] * (along[3] - along[2]);
    const double dy = (1 - t[2]) * (along[1] - along[0]) + t[2] * (along[3] - along[2]);
    gradient = Vec3(dx, dy, high - low) / spacing_;
    const double length = gradient.norm();
    if (length > 1e-9) gradient /= length;
    const Vec3 beyond = spacing_ * (u - inside);
    const double out = beyond.norm();
    if (out > 0) gradient = beyond / out;
    return low + t[2] * (high - low) + out;
  }

 private:
  std::size_t node(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(n_[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(n_[0]) +
           static_cast<std::size_t>(x);
  }

  Vec3 origin_;
  double spacing_, extent_;
  Eigen::Array3i n_;
  std::vector<float> value_;
};

struct Tried {
  Pose pose;
  double cost = std::numeric_limits<double>::infinity(); // [m^2]
};

// Robust Gauss-Newton iterations.
void improve(Tried& tried, const DistanceGrid& grid, const std::vector<Vec3>& points, int rounds) {
  for (int round = 0; round <= rounds; ++round) {
    const PoseScaling scale = scaleOf(points, tried.pose);
    Mat6 normal = Mat6::Zero();
    Vec6 right = Vec6::Zero();
    std::vector<double> residuals;
    std::vector<Vec6> gradients;
    for (const Vec3& point : points) {
      const Vec3 p = tried.pose * point;
      Vec3 direction;
      residuals.push_back(grid.at(p, direction));
      gradients.push_back(scale.gradient(p, direction));
    }
    std::vector<double> sizes;
    for (const double residual : residuals) sizes.push_back(std::abs(residual));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 6 / 10);
    std::nth_element(sizes.begin(), middle, sizes.end());
    const double s = std::max(1.5 * *middle, 0.3 * grid.spacing());
    tried.cost = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double r2 = residuals[i] * residuals[i];
      const double far = 2 * grid.spacing();
      tried.cost += r2 / (1 + r2 / (far * far));
      const double q = s * s / (s * s + r2);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(gradients[i], q * q);
      right -= q * q * residuals[i] * gradients[i];
    }
    tried.cost /= static_cast<double>(points.size());
    if (round == rounds) return;
    normal.diagonal().array() += 1e-2 * normal.diagonal().maxCoeff();
    Vec6 step = SymmetricSolver(normal).solve(right);
    limit(step, scale, grid.extent());
    tried.pose = scale.motion(step) * tried.pose;
  }
}

std::vector<Vec3> thinned(const std::vector<Vec3>& points, std::size_t count) {
  std::vector<Vec3> finite, few;
  for (const Vec3& p : points)
    if (p.allFinite()) finite.push_back(p);
  for (std::size_t i = 0; i < count && !finite.empty(); ++i)
    few.push_back(finite[i * finite.size() / count]);
  return few;
}

bool same(const Pose& a, const Pose& b, const std::vector<Vec3>& points, double near) {
  double squares = 0;
  for (const Vec3& p : points) squares += (a * p - b * p).squaredNorm();
  return squares < near * near * static_cast<double>(points.size());
}

void keepBest(std::vector<Tried>& tried, std::size_t count) {
  count = std::clamp<std::size_t>(count, 1, tried.size());
  std::nth_element(tried.begin(), tried.begin() + static_cast<std::ptrdiff_t>(count) - 1,
                   tried.end(), [](const Tried& a, const Tried& b) { return a.cost < b.cost; });
  tried.resize(count);
}

} // namespace

std::vector<Pose> coarsePoses(const SurfaceTarget& target, const std::vector<Vec3>& points,
                              const Pose& start, const CoarseSearch& search, Progress& progress) {
  const std::vector<Vec3> few = thinned(points, kFew), more = thinned(points, kMore);
  const PoseScaling scale = scaleOf(points, start);
  const DistanceGrid grid(target, 0.25 * bounds(target.mesh()).sizes().maxCoeff());
  std::mt19937 random(search.seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto inBall = [&] {
    for (;;) {
      const Vec3 v(uniform(random), uniform(random), uniform(random));
      if (v.squaredNorm() <= 1) return v;
    }
  };
  std::vector<Tried> tried(std::max<std::size_t>(search.starts, 1));
  for (std::size_t i = 0; i < tried.size(); ++i) {
    Vec6 motion;
    motion << search.rotation * scale.radius * inBall(), search.translation * inBall();
    tried[i].pose = (i == 0 ? Pose::Identity() : scale.motion(motion)) * start;
    improve(tried[i], grid, few, 3);
    if (i % 100 == 0) progress.throwIfCancelled();
  }
  keepBest(tried, search.starts / 5);
  for (Tried& one : tried) improve(one, grid, few, 4);
  keepBest(tried, search.starts / 20);
  for (Tried& one : tried) improve(one, grid, more, 5);
  std::sort(tried.begin(), tried.end(),
            [](const Tried& a, const Tried& b) { return a.cost < b.cost; });
  std::vector<Pose> poses;
  for (const Tried& one : tried) {
    const bool known = std::any_of(poses.begin(), poses.end(), [&](const Pose& pose) {
      return same(pose, one.pose, few, kSame * scale.radius);
    });
    if (!known) poses.push_back(one.pose);
    if (poses.size() == search.keep) break;
  }
  return poses;
}

} // namespace patina
