#include "acquisition/registration/next_stroke.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <unordered_map>

#include "acquisition/registration/error_map.h"
#include "core/decompose.h"

namespace patina {
namespace {

constexpr std::size_t kSites = 1500;   // places at which area and heights are judged
constexpr double kPriorRotation = 0.5; // [rad]
constexpr double kMaxCrease = 0.5;     // cosine of the largest turn of the normal in one step
constexpr double kMinProgress = 0.3;   // part of a step; shorter ones have met the boundary

struct Site {
  Vec3 point, normal;
};

// Points in cells of one side, to find those within it.
class SiteGrid {
 public:
  SiteGrid(const std::vector<Site>& sites, double side) : side_(side), sites_(sites) {
    for (std::size_t i = 0; i < sites.size(); ++i)
      cells_[keyOf(cellOf(sites[i].point))].push_back(i);
  }
  // Calls visit(i, weight) for the sites on the same side of the surface within a cell's side.
  template <class Visit>
  void forEachNear(const Vec3& p, const Vec3& normal, const Visit& visit) const {
    const std::array<std::int64_t, 3> cell = cellOf(p);
    for (std::int64_t x = cell[0] - 1; x <= cell[0] + 1; ++x)
      for (std::int64_t y = cell[1] - 1; y <= cell[1] + 1; ++y)
        for (std::int64_t z = cell[2] - 1; z <= cell[2] + 1; ++z) {
          const auto found = cells_.find(keyOf({x, y, z}));
          if (found == cells_.end()) continue;
          for (const std::size_t i : found->second) {
            const double square = (sites_[i].point - p).squaredNorm() / (side_ * side_);
            if (square < 1 && sites_[i].normal.dot(normal) > 0)
              visit(i, (1 - square) * (1 - square));
          }
        }
  }

 private:
  std::array<std::int64_t, 3> cellOf(const Vec3& p) const {
    return {std::llround(p.x() / side_), std::llround(p.y() / side_), std::llround(p.z() / side_)};
  }
  // Returns a number that differs between cells less than two million apart along each axis.
  static std::int64_t keyOf(const std::array<std::int64_t, 3>& cell) {
    constexpr std::int64_t kMask = (1 << 21) - 1;
    return (cell[0] & kMask) | (cell[1] & kMask) << 21 | (cell[2] & kMask) << 42;
  }
  double side_;
  const std::vector<Site>& sites_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

// Returns places that are spread evenly over the reachable area (systematic sampling).
std::vector<Site> sitesOn(const TriangleMesh& mesh, const std::vector<bool>& reachable) {
  std::vector<double> sums;
  double sum = 0;
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    const Vec3 a = mesh.corner(face, 0), b = mesh.corner(face, 1), c = mesh.corner(face, 2);
    if (reachable.empty() || reachable[face]) sum += (b - a).cross(c - a).norm() / 2;
    sums.push_back(sum);
  }
  std::vector<Site> sites;
  if (!(sum > 0)) return sites;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(0, 1);
  for (std::size_t i = 0; i < kSites; ++i) {
    const double at = sum * (static_cast<double>(i) + part(random)) / kSites;
    const auto face = static_cast<std::size_t>(
        std::min(std::upper_bound(sums.begin(), sums.end(), at), sums.end() - 1) - sums.begin());
    const double root = std::sqrt(part(random)), v = part(random);
    sites.push_back({(1 - root) * mesh.corner(face, 0) + root * (1 - v) * mesh.corner(face, 1) +
                         root * v * mesh.corner(face, 2),
                     faceNormal(mesh, face)});
  }
  return sites;
}

// Reachable area of a mesh, where heights are judged, and the scale of its motions.
class ScanArea {
 public:
  ScanArea(const SurfaceTarget& target, const ScanGoal& goal)
      : radius(goal.radius > 0 ? goal.radius : kErrorRadius * target.extent()),
        sites(sitesOn(target.mesh(), goal.reachable)), grid(sites, radius) {
    std::vector<Vec3> points;
    for (const Site& site : sites) points.push_back(site.point);
    scale = scaleOf(points, Pose::Identity());
    for (const Vec3& p : points)
      for (int axis = 0; axis < 3; ++axis) {
        const Vec6 g = scale.gradient(p, Vec3::Unit(axis));
        displacement += g * g.transpose() / static_cast<double>(points.size());
      }
    prior << Vec3::Constant(kPriorRotation * scale.radius), Vec3::Constant(target.extent() / 2);
  }
  ScanArea(const ScanArea&) = delete;
  ScanArea& operator=(const ScanArea&) = delete;

  const double radius;
  const std::vector<Site> sites;
  const SiteGrid grid;
  PoseScaling scale;
  Mat6 displacement = Mat6::Zero(); // mean squared displacement of the sites by a motion
  Vec6 prior;                       // deviations before any measurement, in PoseScaling's lengths
};

// Information that measurements give of the pose and of the height at each site.
class Information {
 public:
  Information(const ScanArea& area, const ScanGoal& goal)
      : area_(&area), goal_(&goal), heights_(area.sites.size(), 0),
        pose_(area.prior.cwiseAbs2().cwiseInverse().asDiagonal()) {}

  void add(const SurfaceMeasurement& measurement) {
    const Vec6 g =
        area_->scale.gradient(measurement.point, measurement.direction) / measurement.deviation;
    pose_ += g * g.transpose();
    const double height = 1 / (measurement.height_deviation * measurement.height_deviation);
    area_->grid.forEachNear(
        measurement.point, measurement.direction,
        [&](std::size_t site, double weight) { heights_[site] += weight * height; });
  }

  MatX covariance() const { return SymmetricSolver(pose_).inverse(); }
  double poseDeviation() const {
    return std::sqrt(SymmetricSolver(pose_).solveColumns(area_->displacement).trace());
  }
  // Share of the information that the height at a site needs.
  double share(std::size_t site) const {
    return std::min(1., heights_[site] * goal_->height * goal_->height);
  }
  // Share of the area whose heights meet the goal, and mean of share() over the area.
  double met() const {
    double sum = 0;
    for (std::size_t i = 0; i < heights_.size(); ++i) sum += share(i) >= 1;
    return sum / static_cast<double>(std::max<std::size_t>(heights_.size(), 1));
  }
  double meanShare() const {
    double sum = 0;
    for (std::size_t i = 0; i < heights_.size(); ++i) sum += share(i);
    return sum / static_cast<double>(std::max<std::size_t>(heights_.size(), 1));
  }
  bool isComplete() const { return poseDeviation() <= goal_->pose && met() >= goal_->area; }

 private:
  const ScanArea* area_;
  const ScanGoal* goal_;
  std::vector<double> heights_; // [1/m^2]
  Mat6 pose_;                   // in PoseScaling's lengths
};

void requireValid(const SurfaceTarget& target, const ScanGoal& goal) {
  if (!(goal.pose > 0 && goal.height > 0 && goal.area > 0))
    throw std::invalid_argument("nextStroke: a goal is not positive");
  if (!goal.reachable.empty() && goal.reachable.size() != target.mesh().triangles.size())
    throw std::invalid_argument("nextStroke: reachable does not have one value per face");
}

// Share of the way from `before` to `goal` that leads to `after`, of logarithms.
double logShare(double before, double after, double goal) {
  if (!(before > goal)) return 0;
  return std::log(before / std::max(after, goal)) / std::log(before / goal);
}

std::vector<SurfaceMeasurement> expectedOf(const SurfaceTarget& target,
                                           const std::vector<Vec3>& points,
                                           const StrokeOptions& options) {
  std::vector<SurfaceMeasurement> expected;
  for (const Vec3& p : points) {
    const auto face = static_cast<std::size_t>(target.tree().closestPoint(p).surface.face);
    expected.push_back(
        {p, faceNormal(target.mesh(), face), options.deviation, options.height_deviation});
  }
  return expected;
}

// Walks from a point along a direction; appends the points after it.
void walk(const SurfaceTarget& target, Vec3 at, Vec3 along, double length, double spacing,
          std::vector<Vec3>& points) {
  ClosestPoint foot = target.tree().closestPoint(at);
  Vec3 normal = faceNormal(target.mesh(), static_cast<std::size_t>(foot.surface.face));
  for (double walked = spacing; walked <= length + 1e-9; walked += spacing) {
    along = (along - normal * normal.dot(along)).normalized();
    foot = target.tree().closestPoint(at + spacing * along, foot.surface.face);
    const Vec3 next_normal = faceNormal(target.mesh(), static_cast<std::size_t>(foot.surface.face));
    if (next_normal.dot(normal) < kMaxCrease || (foot.point - at).norm() < kMinProgress * spacing)
      return;
    at = foot.point;
    normal = next_normal;
    points.push_back(at);
  }
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace

std::vector<SurfaceMeasurement> measurementsOf(const Registration& registration,
                                               double height_deviation) {
  std::vector<SurfaceMeasurement> measurements;
  double due = 0;
  for (std::size_t i = 0; i < registration.residuals.size(); ++i) {
    if (!registration.inliers[i] || ++due < registration.correlation_length) continue;
    due -= std::max(1., registration.correlation_length);
    const SurfaceResidual& residual = registration.residuals[i];
    measurements.push_back({residual.at, residual.direction, registration.noise, height_deviation});
  }
  return measurements;
}

StrokeOptions strokeOptionsFor(const std::vector<SurfaceMeasurement>& measurements) {
  StrokeOptions options;
  if (measurements.size() < 2) return options;
  std::vector<double> spacings, deviations, heights;
  for (std::size_t i = 1; i < measurements.size(); ++i) {
    spacings.push_back((measurements[i].point - measurements[i - 1].point).norm());
    deviations.push_back(measurements[i].deviation);
    heights.push_back(measurements[i].height_deviation);
  }
  options.spacing = std::clamp(medianOf(std::move(spacings)), 1e-4, options.length / 8);
  options.deviation = std::max(medianOf(std::move(deviations)), 1e-6);
  options.height_deviation = std::max(medianOf(std::move(heights)), 1e-6);
  return options;
}

ScanKnowledge knowledgeOf(const SurfaceTarget& target,
                          const std::vector<SurfaceMeasurement>& measurements,
                          const ScanGoal& goal) {
  requireValid(target, goal);
  const ScanArea area(target, goal);
  Information state(area, goal);
  for (const SurfaceMeasurement& each : measurements) state.add(each);
  ScanKnowledge known;
  known.area = state.met();
  known.pose = state.poseDeviation();
  known.complete = state.isComplete();
  known.centre = area.scale.centre;
  Vec6 units;
  units << Vec3::Constant(1 / area.scale.radius), Vec3::Ones();
  const MatX covariance = state.covariance();
  known.covariance = units.asDiagonal() * covariance * units.asDiagonal();
  // Whitened by the displacement, principal motions are orthogonal.
  const SymmetricEigen metric(area.displacement);
  MatX root = metric.vectors, inverse = metric.vectors;
  for (int k = 0; k < 6; ++k) {
    const double length = std::sqrt(std::max(metric.values[k], 1e-12));
    root.col(k) *= length;
    inverse.col(k) /= length;
  }
  const SymmetricEigen principal(product(product(root.transpose(), covariance), root));
  for (int k = 5; k >= 0; --k) {
    const double deviation = std::sqrt(std::max(principal.values[k], 0.));
    const VecX motion = deviation * product(inverse, principal.vectors.col(k));
    known.motions.push_back({motion.head<3>() / area.scale.radius, motion.tail<3>(), deviation});
  }

  const TriangleMesh& mesh = target.mesh();
  std::vector<Site> vertices;
  for (const Vec3& p : mesh.positions) vertices.push_back({p, Vec3::Zero()});
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
    for (const std::int32_t vertex : mesh.triangles[face])
      vertices[static_cast<std::size_t>(vertex)].normal += faceNormal(mesh, face);
  std::vector<double> information(vertices.size(), 0);
  const SiteGrid grid(vertices, area.radius);
  for (const SurfaceMeasurement& each : measurements)
    grid.forEachNear(each.point, each.direction, [&](std::size_t vertex, double weight) {
      information[vertex] += weight / (each.height_deviation * each.height_deviation);
    });
  for (const double each : information)
    known.height_deviation.push_back(static_cast<float>(1 / std::sqrt(each)));
  return known;
}

std::vector<Vec3> strokeOver(const SurfaceTarget& target, const Vec3& start, const Vec3& direction,
                             double length, double spacing) {
  std::vector<Vec3> points;
  walk(target, start, -direction, length / 2, spacing, points);
  std::reverse(points.begin(), points.end());
  points.push_back(target.tree().closestPoint(start).point);
  walk(target, start, direction, length / 2, spacing, points);
  return points;
}

std::optional<ScanStroke> nextStroke(const SurfaceTarget& target,
                                     const std::vector<SurfaceMeasurement>& measurements,
                                     const ScanGoal& goal, const StrokeOptions& options) {
  requireValid(target, goal);
  if (!(options.length > 0 && options.spacing > 0 && options.deviation > 0 &&
        options.height_deviation > 0) ||
      options.starts < 1 || options.directions < 1)
    throw std::invalid_argument("nextStroke: an option is not positive");
  const ScanArea area(target, goal);
  Information state(area, goal);
  for (const SurfaceMeasurement& each : measurements) state.add(each);
  if (area.sites.empty() || state.isComplete()) return std::nullopt;

  std::vector<double> lacking;
  for (std::size_t i = 0; i < area.sites.size(); ++i) lacking.push_back(1.02 - state.share(i));
  std::mt19937 random(options.seed);
  std::discrete_distribution<std::size_t> start(lacking.begin(), lacking.end());
  const double pose = state.poseDeviation(), height = state.meanShare();
  std::optional<ScanStroke> best;
  double best_gain = 0;
  for (int s = 0; s < options.starts; ++s) {
    const Site& site = area.sites[start(random)];
    const Vec3 across = site.normal.unitOrthogonal(), other = site.normal.cross(across);
    for (int d = 0; d < options.directions; ++d) {
      const double angle = std::numbers::pi * (d + 0.5) / options.directions;
      ScanStroke stroke{strokeOver(target, site.point,
                                   std::cos(angle) * across + std::sin(angle) * other,
                                   options.length, options.spacing)};
      if (stroke.points.size() < 3) continue;
      Information after = state;
      for (const SurfaceMeasurement& each : expectedOf(target, stroke.points, options))
        after.add(each);
      stroke.pose = after.poseDeviation();
      stroke.area = after.met();
      double gain = logShare(pose, stroke.pose, goal.pose);
      if (height < 1) gain += (after.meanShare() - height) / (1 - height);
      if (gain <= best_gain) continue;
      best_gain = gain;
      best = std::move(stroke);
    }
  }
  return best;
}

} // namespace patina
