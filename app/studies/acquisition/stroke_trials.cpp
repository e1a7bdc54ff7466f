#include "app/studies/acquisition/stroke_trials.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "app/studies/acquisition/registration_consistency.h"
#include "app/studies/framework/query_timing.h"
#include "core/percentiles.h"

namespace patina {
namespace {

constexpr std::size_t kMaxStrokes = 300;
constexpr double kNoise = 0.3e-3, kHand = 1e-3; // [m]
constexpr double kRasterSpacing = 0.011;        // width that one stroke makes known [m]

class RandomHand {
 public:
  RandomHand(const TriangleMesh& mesh, unsigned seed) : mesh_(mesh), random_(seed) {
    std::vector<double> areas;
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
      areas.push_back((mesh.corner(face, 1) - mesh.corner(face, 0))
                          .cross(mesh.corner(face, 2) - mesh.corner(face, 0))
                          .norm());
    faces_ = std::discrete_distribution<std::size_t>(areas.begin(), areas.end());
  }
  Vec3 noise(double deviation) {
    std::normal_distribution<double> normal(0, deviation);
    return {normal(random_), normal(random_), normal(random_)};
  }
  std::vector<Vec3> stroke(const SurfaceTarget& target, const StrokeOptions& options) {
    const std::size_t face = faces_(random_);
    const Vec3 start = (mesh_.corner(face, 0) + mesh_.corner(face, 1) + mesh_.corner(face, 2)) / 3;
    return strokeOver(target, start, noise(1).normalized(), options.length, options.spacing);
  }

 private:
  const TriangleMesh& mesh_;
  std::mt19937 random_;
  std::discrete_distribution<std::size_t> faces_;
};

// Returns all strokes of a raster, in their order.
std::vector<std::vector<Vec3>> rasterOver(const SurfaceTarget& target,
                                          const StrokeOptions& options) {
  std::vector<std::vector<Vec3>> strokes;
  const Box3 box = bounds(target.mesh());
  for (const double shift : {0.5, 0.})
    for (const int way : {0, 1, 2, 3}) {
      const int along = way / 2, across = 1 - along;
      const double side = way % 2 == 0 ? 1 : -1;
      for (double v = box.min()[across] + shift * kRasterSpacing; v < box.max()[across];
           v += kRasterSpacing)
        for (double u = box.min()[along] + options.length / 2;
             u < box.max()[along] + options.length / 2; u += options.length) {
          Vec3 from = box.center() + side * box.sizes().z() * Vec3::UnitZ();
          from[across] = v;
          from[along] = std::min(u, box.max()[along]);
          const auto hit = target.tree().firstHit(from, -side * Vec3::UnitZ(), 2 * box.sizes().z());
          if (!hit) continue;
          strokes.push_back(strokeOver(target, from - side * hit->t * Vec3::UnitZ(),
                                       Vec3::Unit(along), options.length, options.spacing));
        }
    }
  return strokes;
}

std::vector<SurfaceMeasurement> measurementsIn(const std::vector<SurfaceResidual>& residuals) {
  std::vector<SurfaceMeasurement> measurements;
  for (const SurfaceResidual& each : residuals)
    measurements.push_back({each.at, each.direction, kNoise, kNoise});
  return measurements;
}

double displacementOf(const Pose& pose, const TriangleMesh& mesh) {
  double squares = 0;
  for (const Vec3& p : mesh.positions) squares += (pose * p - p).squaredNorm();
  return std::sqrt(squares / static_cast<double>(mesh.positions.size()));
}

} // namespace

ScanGoal trialGoal() {
  ScanGoal goal;
  goal.radius = 0.01;
  return goal;
}

StrokeOptions trialStrokes() {
  StrokeOptions options;
  options.length = 0.08;
  options.spacing = 2e-3;
  options.deviation = options.height_deviation = kNoise;
  return options;
}

StrokeTrial strokesUntilKnown(const SurfaceTarget& target, StrokeChoice choice, unsigned seed) {
  const ScanGoal goal = trialGoal();
  StrokeOptions options = trialStrokes();
  RandomHand hand(target.mesh(), seed);
  const std::vector<std::vector<Vec3>> raster = rasterOver(target, options);
  Pose pose = Pose::Identity(); // an estimate; the true one is the identity
  const Vec3 centre = bounds(target.mesh()).center();
  pose.linear() =
      Eigen::AngleAxisd(0.05, hand.noise(1).normalized()).toRotationMatrix(); // 3 degrees
  pose.translation() = centre - pose.linear() * centre + 3e-3 * hand.noise(1).normalized();
  std::vector<Vec3> truth, path;
  std::vector<SurfaceResidual> residuals;
  StrokeTrial trial;
  const double begin = threadSeconds();
  while (trial.strokes < kMaxStrokes) {
    std::vector<Vec3> planned;
    if (choice == StrokeChoice::advised) {
      options.seed = seed * 1000 + static_cast<unsigned>(trial.strokes);
      if (const auto stroke = nextStroke(target, measurementsIn(residuals), goal, options))
        planned = stroke->points;
    }
    if (choice == StrokeChoice::raster) planned = raster[trial.strokes % raster.size()];
    if (planned.empty()) planned = hand.stroke(target, options);
    const Vec3 aside = hand.noise(kHand);
    for (const Vec3& p : planned) {
      truth.push_back(target.tree().closestPoint(p + aside).point);
      path.push_back(truth.back() + hand.noise(kNoise));
    }
    ++trial.strokes;
    const PathFit fit = fitPath(target, path, pose); // there are no outliers
    pose = fit.mesh_from_path;
    residuals = fit.residuals;
    trial.error = displacementOf(pose, target.mesh());
    if (trial.error > goal.pose) continue;
    std::vector<SurfaceResidual> exact;
    for (const Vec3& p : truth) exact.push_back(target.residual(p));
    trial.area = knowledgeOf(target, measurementsIn(exact), goal).area;
    if (trial.area >= goal.area) break;
  }
  trial.seconds = threadSeconds() - begin;
  return trial;
}

WorkPrecisionTable strokeTable(const StudyOptions& options, Progress& progress) {
  const unsigned count = options.quick ? 1 : options.thorough ? 20 : 5;
  WorkPrecisionTable table =
      tableOf("Strokes of 80 mm until the pose errs by less than 0.1 mm and the heights of 95 % of "
              "the area are known to 0.2 mm, mean of " +
                  std::to_string(count) +
                  " seeds; ns is per stroke, its choice and the registration included",
              "mm");
  std::vector<TrustBody> bodies = trustBodies(4);
  bodies.erase(bodies.begin(), bodies.begin() + 2); // a stone and a bumpy sheet are scanned whole
  if (options.quick) bodies.pop_back();
  for (const TrustBody& body : bodies) {
    const SurfaceTarget target(body.mesh, 0, true);
    for (const auto& [name, choice] : {std::pair{"advised", StrokeChoice::advised},
                                       {"random", StrokeChoice::random},
                                       {"raster", StrokeChoice::raster}}) {
      if (options.quick && choice == StrokeChoice::raster) continue;
      std::vector<double> errors, strokes;
      double seconds = 0, sum = 0;
      for (unsigned seed = 1; seed <= count; ++seed) {
        progress.throwIfCancelled();
        const StrokeTrial trial = strokesUntilKnown(target, choice, seed);
        errors.push_back(trial.error);
        strokes.push_back(static_cast<double>(trial.strokes));
        sum += strokes.back();
        seconds += trial.seconds;
      }
      WorkPrecisionRow row;
      row.error = 1e3 * percentiles(errors).p50;
      row.error_max = 1e3 * *std::max_element(errors.begin(), errors.end());
      row.ns = 1e9 * seconds / sum;
      row.settings = {{"body", body.name}, {"choice", name}};
      row.more = {{"strokes", sum / count},
                  {"most strokes", *std::max_element(strokes.begin(), strokes.end())}};
      table.rows.push_back(row);
    }
  }
  return table;
}

} // namespace patina
