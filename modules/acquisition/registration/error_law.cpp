#include "acquisition/registration/error_law.h"

#include <algorithm>
#include <cmath>

#include "core/decompose.h"

namespace patina {
namespace {

constexpr std::size_t kBlocks = 128; // points are averaged down to about so many
constexpr double kSpanned = 1e-10;   // squared: columns less apart than that are the same
constexpr double kFewestPoints = 16; // points: fewer tell nothing of how they go together

struct Blocks {
  double size = 1;   // points in one
  double within = 0; // mean square of points' misses off their block's [m^2]
  MatX gradients;
  VecX misses;
};

Blocks blocksOf(const std::vector<Vec3>& points, const PathFit& fit, const ScanForces& forces) {
  const MotionScale scale = scaleOf(points, fit.mesh_from_path);
  const auto columns = static_cast<Eigen::Index>(6 + forces.scans());
  std::vector<std::size_t> counting;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (fit.weights[i] > 0) counting.push_back(i);
  const std::size_t size = counting.size() / kBlocks + 1;
  const auto count = static_cast<Eigen::Index>((counting.size() + size - 1) / size);
  Blocks blocks{static_cast<double>(size), 0, MatX::Zero(count, columns), VecX::Zero(count)};
  for (std::size_t k = 0; k < counting.size(); ++k) {
    const std::size_t i = counting[k], first = k / size * size;
    const double share = 1. / static_cast<double>(std::min(size, counting.size() - first));
    const auto row = static_cast<Eigen::Index>(k / size);
    blocks.gradients.row(row).head<6>() +=
        share * scale.gradient(fit.mesh_from_path * points[i], fit.misses[i].direction).transpose();
    if (columns > 6)
      blocks.gradients(row, static_cast<Eigen::Index>(6 + forces.scanOf(i))) +=
          share * forces.over(i);
    blocks.misses[row] += share * fit.misses[i].distance;
  }
  for (std::size_t k = 0; k < counting.size(); ++k) {
    const double off =
        fit.misses[counting[k]].distance - blocks.misses[static_cast<Eigen::Index>(k / size)];
    blocks.within += off * off / static_cast<double>(counting.size());
  }
  return blocks;
}

// Matern's of order 3/2: as smooth as what a filter leaves of velocities.
double likeness(double lag, double reach) {
  const double a = std::sqrt(3.) * lag / reach;
  return (1 + a) * std::exp(-a);
}

// One law that is tried: the part `alone` of a block's variance is its own.
struct TriedLaw {
  double reach = 1, alone = 1; // [blocks], of 1
  double weight = 0;           // logarithm of the restricted likelihood, and what it was beforehand
  double variance = 0;         // of a block's miss [m^2]
  MatX scatter = {};
};

void judgeLaw(TriedLaw& tried, const Blocks& blocks, const MatX& design) {
  const Eigen::Index n = blocks.misses.size(), seen = design.cols();
  MatX law(n, n);
  VecX by_lag(n);
  for (Eigen::Index lag = 0; lag < n; ++lag)
    by_lag[lag] = (1 - tried.alone) * likeness(static_cast<double>(lag), tried.reach);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) law(i, j) = law(j, i) = by_lag[i - j];
  law.diagonal().array() += tried.alone;
  const SymmetricSolver root(law);
  MatX whole(n, seen + 1);
  whole << design, blocks.misses;
  const MatX squares = product(whole.transpose(), root.solveColumns(whole));
  const SymmetricSolver normal(squares.topLeftCorner(seen, seen));
  const VecX right = squares.col(seen).head(seen);
  const double left = squares(seen, seen) - right.dot(normal.solve(right));
  const auto freedom = static_cast<double>(n - seen);
  tried.variance = std::max(left, 1e-300) / (freedom - 2);
  tried.weight =
      -0.5 * (root.logDeterminant() + normal.logDeterminant() + freedom * std::log(tried.variance));
  tried.scatter =
      tried.variance * product(blocks.gradients.transpose(), product(law, blocks.gradients));
}

// What is expected of a compliance keeps a force that never changes from being taken for a shift.
ErrorLaw withPrior(ErrorLaw law, double block, const ScanForces& forces) {
  for (std::size_t scan = 0; scan < forces.scans(); ++scan) {
    const auto column = static_cast<Eigen::Index>(6 + scan);
    const double known = std::max(forces.depthDeviation(scan), 1e-12); // [m]
    const double weight = law.deviation * law.deviation * law.together / block / (known * known);
    law.normal(column, column) += weight;
    law.scatter(column, column) += weight * weight * known * known;
  }
  return law;
}

// Its columns' span by as many that are orthonormal: a force that never changes may lie in what the
// motions span, and then no law would have a determinant.
MatX spanOf(const MatX& columns) {
  const MatX even = columns.array().rowwise() / columns.colwise().norm().cwiseMax(1e-300).array();
  const SymmetricEigen eigen(product(even.transpose(), even));
  Eigen::Index count = 0;
  while (count < even.cols() && eigen.values[even.cols() - 1 - count] > kSpanned) ++count;
  const VecX scale = eigen.values.tail(count).cwiseSqrt().cwiseInverse();
  return product(even, product(eigen.vectors.rightCols(count), MatX(scale.asDiagonal())));
}

} // namespace

Mat6 ErrorLaw::covariance(const Eigen::Matrix<double, 6, Eigen::Dynamic>& free) const {
  const Eigen::Index count = 6 - free.cols();
  if (count == 0) return Mat6::Zero();
  const Eigen::Index more = normal.cols() - 6;
  MatX seen = MatX::Identity(normal.cols(), count + more);
  // What is free has the value 1 here, and what is seen 0.
  seen.topLeftCorner(6, count) =
      SymmetricEigen(product(free, free.transpose())).vectors.leftCols(count);
  seen.block(0, count, 6, more).setZero();
  seen.bottomRows(more).setZero();
  seen.bottomRightCorner(more, more).setIdentity();
  const MatX turned = seen.transpose();
  const SymmetricSolver ours(product(turned, product(normal, seen)));
  const MatX half = ours.solveColumns(product(turned, product(scatter, seen)));
  const MatX whole = product(seen, product(ours.solveColumns(half.transpose()), turned));
  return whole.topLeftCorner<6, 6>();
}

ErrorLaw errorLaw(const std::vector<Vec3>& points, const PathFit& fit, double noise,
                  const ScanForces& forces) {
  const Blocks blocks = blocksOf(points, fit, forces);
  ErrorLaw law;
  law.normal = product(blocks.gradients.transpose(), blocks.gradients);
  const auto count = static_cast<double>(blocks.misses.size());
  const SymmetricEigen eigen(law.normal.topLeftCorner<6, 6>());
  Eigen::Index seen = 0;
  while (seen < 6 && eigen.values[5 - seen] > kBlind * eigen.values[5]) ++seen;
  if (count < kFewestPoints + static_cast<double>(forces.scans())) {
    law.deviation = std::max(
        noise, fit.rms * std::sqrt(count / std::max(count - static_cast<double>(seen), 1.0)));
    law.scatter = law.deviation * law.deviation * law.normal;
    return withPrior(std::move(law), 1, forces);
  }
  const auto scans = static_cast<Eigen::Index>(forces.scans());
  MatX design(blocks.gradients.rows(), seen + scans);
  design.leftCols(seen) = product(blocks.gradients.leftCols(6), eigen.vectors.rightCols(seen));
  design.rightCols(scans) = blocks.gradients.rightCols(scans);
  design = spanOf(design);
  std::vector<TriedLaw> all;
  for (const double alone : {1e-3, 0.03, 0.2, 0.6})
    for (double reach = 1; reach < 0.3 * count; reach *= 2) all.push_back({reach, alone});
  // What the fit has taken out of the misses would let long reaches pass for nothing in common:
  // beforehand they weigh less, and nothing in common as much as there are others.
  const auto others = static_cast<double>(all.size());
  all.push_back({1, 1});
  for (TriedLaw& tried : all) {
    judgeLaw(tried, blocks, design);
    tried.weight += std::log(tried.alone < 1 ? 1 / tried.reach : others);
  }
  const double most =
      std::max_element(all.begin(), all.end(), [](const TriedLaw& a, const TriedLaw& b) {
        return a.weight < b.weight;
      })->weight;
  // Of a block: its variance, and that times the blocks that are worth one.
  double sum = 0, variance = 0, shared = 0;
  MatX scatter = 0 * law.normal;
  for (const TriedLaw& tried : all) {
    const double weight = std::exp(tried.weight - most);
    sum += weight;
    variance += weight * tried.variance;
    // Of Matern's law the sum over all lags is 4 / sqrt 3 of its reach.
    shared += weight * tried.variance *
              (tried.alone + (1 - tried.alone) * 4 / std::sqrt(3.) * tried.reach);
    scatter += weight * tried.scatter;
  }
  // What points in a block go together by is in how much their mean varies.
  const double square = variance / sum + blocks.within;
  const double together = blocks.size * shared / sum / square;
  law.together = std::max(1., together);
  law.deviation = std::max(noise, std::sqrt(square));
  law.scatter = law.deviation * law.deviation / square * law.together / together / sum * scatter;
  return withPrior(std::move(law), blocks.size, forces);
}

} // namespace patina
