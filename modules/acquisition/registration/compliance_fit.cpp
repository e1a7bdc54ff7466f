#include "acquisition/registration/compliance_fit.h"

#include <algorithm>
#include <cmath>

#include "core/decompose.h"

namespace patina {
namespace {

constexpr int kYieldRounds = 6;
constexpr double kDepthTolerance = 1e-2; // tolerance of the depth over rms / sqrt(n)

} // namespace

ScanForces::ScanForces(const std::vector<double>& force, const std::vector<std::size_t>& scan,
                       const std::vector<ExpectedCompliance>& expected)
    : force_(force), scan_(scan), expected_(expected) {
  std::vector<double> counts;
  for (std::size_t i = 0; i < force_.size(); ++i) {
    const std::size_t of = scanOf(i);
    rms_force_.resize(std::max(rms_force_.size(), of + 1));
    counts.resize(rms_force_.size());
    rms_force_[of] += force_[i] * force_[i];
    ++counts[of];
  }
  for (std::size_t s = 0; s < rms_force_.size(); ++s)
    rms_force_[s] = std::sqrt(rms_force_[s] / std::max(1., counts[s]));
  expected_.resize(rms_force_.size());
}

double ScanForces::over(std::size_t point) const {
  const double usual = rms_force_[scanOf(point)];
  return usual > 0 ? force_[point] / usual : 0;
}

std::vector<double> ScanForces::indentations(const std::vector<double>& compliances) const {
  std::vector<double> depths;
  for (std::size_t i = 0; i < force_.size(); ++i)
    depths.push_back(compliances[scanOf(i)] * force_[i]);
  return depths;
}

ComplianceFit fitPoseAndCompliance(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                   const ScanForces& forces, const PathFit& rigid_fit,
                                   double correlation_length, const FitOptions& options) {
  const std::size_t scans = forces.scans();
  const auto columns = static_cast<Eigen::Index>(6 + scans);
  ComplianceFit found{rigid_fit, std::vector<double>(scans, 0)};
  for (int round = 0; round < kYieldRounds; ++round) {
    const PoseScaling scale = scaleOf(points, found.fit.mesh_from_path);
    MatX normal = MatX::Zero(columns, columns);
    VecX right = VecX::Zero(columns);
    double inlier_count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (found.fit.weights[i] == 0) continue;
      VecX g = VecX::Zero(columns);
      g.head<6>() =
          scale.gradient(found.fit.mesh_from_path * points[i], found.fit.residuals[i].direction);
      g[static_cast<Eigen::Index>(6 + forces.scanOf(i))] = forces.over(i);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(g);
      right -= found.fit.residuals[i].distance * g;
      ++inlier_count;
    }
    for (std::size_t s = 0; s < scans; ++s) {
      if (!(forces.rmsForce(s) > 0)) continue;
      const auto column = static_cast<Eigen::Index>(6 + s);
      const double known = forces.depthDeviation(s);
      const double weight = found.fit.rms * found.fit.rms * correlation_length / (known * known);
      normal(column, column) += weight;
      right[column] +=
          weight * (forces.expectedDepth(s) - found.compliances[s] * forces.rmsForce(s));
    }
    const SymmetricEigen eigen(normal); // reads the lower half
    VecX step = VecX::Zero(columns);
    for (Eigen::Index k = 0; k < columns; ++k)
      if (eigen.values[k] > kRankTolerance * eigen.values[columns - 1])
        step += eigen.vectors.col(k) * eigen.vectors.col(k).dot(right) / eigen.values[k];
    double change = 0; // change of a depth at the rms force [m]
    for (std::size_t s = 0; s < scans; ++s) {
      if (!(forces.rmsForce(s) > 0)) continue;
      const double before = found.compliances[s] * forces.rmsForce(s);
      const double depth = std::max(0., before + step[static_cast<Eigen::Index>(6 + s)]);
      found.compliances[s] = depth / forces.rmsForce(s);
      change = std::max(change, std::abs(depth - before));
    }
    Vec6 motion = step.head<6>();
    limit(motion, scale, target.extent());
    FitOptions fitting = options;
    fitting.indentations = forces.indentations(found.compliances);
    const int iterations = found.fit.iterations;
    const std::size_t evaluations = found.fit.evaluations;
    found.fit = fitPath(target, points, scale.motion(motion) * found.fit.mesh_from_path, fitting);
    found.fit.iterations += iterations;
    found.fit.evaluations += evaluations;
    if (change < kDepthTolerance * found.fit.rms / std::sqrt(std::max(inlier_count, 1.))) break;
  }
  return found;
}

} // namespace patina
