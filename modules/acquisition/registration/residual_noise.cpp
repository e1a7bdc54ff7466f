#include "acquisition/registration/residual_noise.h"

#include <algorithm>
#include <cmath>

#include "core/decompose.h"

namespace patina {
namespace {

constexpr std::size_t kBlocks = 128; // points are averaged to about this number of blocks
constexpr double kSpanned = 1e-10;   // relative eigenvalue below which columns are dependent
constexpr double kMinPoints = 16;    // fewer points do not determine the correlation

struct Blocks {
  double size = 1;   // points per block
  double within = 0; // mean squared deviation of the residuals within a block [m^2]
  MatX gradients;
  VecX residuals;
};

Blocks blocksOf(const std::vector<Vec3>& points, const PathFit& fit, const ScanForces& forces) {
  const PoseScaling scale = scaleOf(points, fit.mesh_from_path);
  const auto columns = static_cast<Eigen::Index>(6 + forces.scans());
  std::vector<std::size_t> inlier_points;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (fit.weights[i] > 0) inlier_points.push_back(i);
  const std::size_t size = inlier_points.size() / kBlocks + 1;
  const auto count = static_cast<Eigen::Index>((inlier_points.size() + size - 1) / size);
  Blocks blocks{static_cast<double>(size), 0, MatX::Zero(count, columns), VecX::Zero(count)};
  for (std::size_t k = 0; k < inlier_points.size(); ++k) {
    const std::size_t i = inlier_points[k], first = k / size * size;
    const double share = 1. / static_cast<double>(std::min(size, inlier_points.size() - first));
    const auto row = static_cast<Eigen::Index>(k / size);
    blocks.gradients.row(row).head<6>() +=
        share *
        scale.gradient(fit.mesh_from_path * points[i], fit.residuals[i].direction).transpose();
    if (columns > 6)
      blocks.gradients(row, static_cast<Eigen::Index>(6 + forces.scanOf(i))) +=
          share * forces.over(i);
    blocks.residuals[row] += share * fit.residuals[i].distance;
  }
  for (std::size_t k = 0; k < inlier_points.size(); ++k) {
    const double off = fit.residuals[inlier_points[k]].distance -
                       blocks.residuals[static_cast<Eigen::Index>(k / size)];
    blocks.within += off * off / static_cast<double>(inlier_points.size());
  }
  return blocks;
}

// Matern correlation of order 3/2, as smooth as a filter's velocities.
double maternCorrelation(double lag, double range) {
  const double a = std::sqrt(3.) * lag / range;
  return (1 + a) * std::exp(-a);
}

// A candidate model; `nugget` is the uncorrelated part of a block's variance (nugget).
struct CandidateModel {
  double range = 1, nugget = 1; // range [blocks] and nugget
  double weight = 0;   // log of the restricted likelihood (Patterson & Thompson 1971) and the prior
  double variance = 0; // variance of a block's residual [m^2]
  MatX score_covariance = {};
};

void scoreModel(CandidateModel& tried, const Blocks& blocks, const MatX& design) {
  const Eigen::Index n = blocks.residuals.size(), seen = design.cols();
  MatX law(n, n);
  VecX by_lag(n);
  for (Eigen::Index lag = 0; lag < n; ++lag)
    by_lag[lag] = (1 - tried.nugget) * maternCorrelation(static_cast<double>(lag), tried.range);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) law(i, j) = law(j, i) = by_lag[i - j];
  law.diagonal().array() += tried.nugget;
  const SymmetricSolver root(law);
  MatX whole(n, seen + 1);
  whole << design, blocks.residuals;
  const MatX squares = product(whole.transpose(), root.solveColumns(whole));
  const SymmetricSolver normal(squares.topLeftCorner(seen, seen));
  const VecX right = squares.col(seen).head(seen);
  const double left = squares(seen, seen) - right.dot(normal.solve(right));
  const auto freedom = static_cast<double>(n - seen);
  tried.variance = std::max(left, 1e-300) / (freedom - 2);
  tried.weight =
      -0.5 * (root.logDeterminant() + normal.logDeterminant() + freedom * std::log(tried.variance));
  tried.score_covariance =
      tried.variance * product(blocks.gradients.transpose(), product(law, blocks.gradients));
}

// Adds the prior of the compliances, which separates them from a shift if the force is constant.
ResidualNoiseModel withPrior(ResidualNoiseModel law, double block, const ScanForces& forces) {
  for (std::size_t scan = 0; scan < forces.scans(); ++scan) {
    const auto column = static_cast<Eigen::Index>(6 + scan);
    const double known = std::max(forces.depthDeviation(scan), 1e-12); // [m]
    const double weight =
        law.deviation * law.deviation * law.correlation_length / block / (known * known);
    law.normal(column, column) += weight;
    law.score_covariance(column, column) += weight * weight * known * known;
  }
  return law;
}

// Returns an orthonormal basis of the columns' span: a constant force may lie in the span of the
// motions, which would make the determinant zero.
MatX spanOf(const MatX& columns) {
  const MatX even = columns.array().rowwise() / columns.colwise().norm().cwiseMax(1e-300).array();
  const SymmetricEigen eigen(product(even.transpose(), even));
  Eigen::Index count = 0;
  while (count < even.cols() && eigen.values[even.cols() - 1 - count] > kSpanned) ++count;
  const VecX scale = eigen.values.tail(count).cwiseSqrt().cwiseInverse();
  return product(even, product(eigen.vectors.rightCols(count), MatX(scale.asDiagonal())));
}

} // namespace

MatX ResidualNoiseModel::wholeCovariance(
    const Eigen::Matrix<double, 6, Eigen::Dynamic>& free) const {
  const Eigen::Index count = 6 - free.cols();
  const Eigen::Index more = normal.cols() - 6;
  MatX seen = MatX::Identity(normal.cols(), count + more);
  // Unobservable directions have the eigenvalue 1 here, observable ones 0.
  seen.topLeftCorner(6, count) =
      SymmetricEigen(product(free, free.transpose())).vectors.leftCols(count);
  seen.block(0, count, 6, more).setZero();
  seen.bottomRows(more).setZero();
  seen.bottomRightCorner(more, more).setIdentity();
  const MatX turned = seen.transpose();
  const SymmetricSolver ours(product(turned, product(normal, seen)));
  const MatX half = ours.solveColumns(product(turned, product(score_covariance, seen)));
  return product(seen, product(ours.solveColumns(half.transpose()), turned));
}

Mat6 ResidualNoiseModel::covariance(const Eigen::Matrix<double, 6, Eigen::Dynamic>& free) const {
  if (free.cols() == 6) return Mat6::Zero();
  return wholeCovariance(free).topLeftCorner<6, 6>();
}

ResidualNoiseModel fitNoiseModel(const std::vector<Vec3>& points, const PathFit& fit, double noise,
                                 const ScanForces& forces) {
  const Blocks blocks = blocksOf(points, fit, forces);
  ResidualNoiseModel law;
  law.normal = product(blocks.gradients.transpose(), blocks.gradients);
  const auto count = static_cast<double>(blocks.residuals.size());
  const SymmetricEigen eigen(law.normal.topLeftCorner<6, 6>());
  Eigen::Index seen = 0;
  while (seen < 6 && eigen.values[5 - seen] > kRankTolerance * eigen.values[5]) ++seen;
  if (count < kMinPoints + static_cast<double>(forces.scans())) {
    law.deviation = std::max(
        noise, fit.rms * std::sqrt(count / std::max(count - static_cast<double>(seen), 1.0)));
    law.score_covariance = law.deviation * law.deviation * law.normal;
    return withPrior(std::move(law), 1, forces);
  }
  const auto scans = static_cast<Eigen::Index>(forces.scans());
  MatX design(blocks.gradients.rows(), seen + scans);
  design.leftCols(seen) = product(blocks.gradients.leftCols(6), eigen.vectors.rightCols(seen));
  design.rightCols(scans) = blocks.gradients.rightCols(scans);
  design = spanOf(design);
  std::vector<CandidateModel> all;
  for (const double nugget : {1e-3, 0.03, 0.2, 0.6})
    for (double range = 1; range < 0.3 * count; range *= 2) all.push_back({range, nugget});
  // The fit removes slow errors from the residuals, which hides long correlations. Their prior is
  // therefore shared, and that of no correlation is equal to their sum.
  const auto others = static_cast<double>(all.size());
  all.push_back({1, 1});
  for (CandidateModel& tried : all) {
    scoreModel(tried, blocks, design);
    tried.weight += std::log(tried.nugget < 1 ? 1 / tried.range : others);
  }
  const double most = std::max_element(all.begin(), all.end(),
                                       [](const CandidateModel& a, const CandidateModel& b) {
                                         return a.weight < b.weight;
                                       })
                          ->weight;
  // Variance of a block, and the same times the blocks per independent one.
  double sum = 0, variance = 0, shared = 0;
  MatX score_covariance = 0 * law.normal;
  for (const CandidateModel& tried : all) {
    const double weight = std::exp(tried.weight - most);
    sum += weight;
    variance += weight * tried.variance;
    // The integral of the Matern correlation over all lags is 4 / sqrt 3 times its range.
    shared += weight * tried.variance *
              (tried.nugget + (1 - tried.nugget) * 4 / std::sqrt(3.) * tried.range);
    score_covariance += weight * tried.score_covariance;
  }
  // The variance of the blocks' means shows the correlation within a block.
  const double square = variance / sum + blocks.within;
  const double correlation_length = blocks.size * shared / sum / square;
  law.correlation_length = std::max(1., correlation_length);
  law.deviation = std::max(noise, std::sqrt(square));
  law.score_covariance = law.deviation * law.deviation / square * law.correlation_length /
                         correlation_length / sum * score_covariance;
  return withPrior(std::move(law), blocks.size, forces);
}

} // namespace patina
