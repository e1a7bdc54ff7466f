#include "core/decompose.h"

#include <gtest/gtest.h>
#include <random>

namespace patina {
namespace {

MatX drawn(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  MatX m(rows, columns);
  for (Eigen::Index k = 0; k < m.size(); ++k) m.data()[k] = normal(random);
  return m;
}

double farthest(const MatX& a, const MatX& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

TEST(Decompose, ReproducesTheMatrixAtAnySize) {
  for (const Eigen::Index n : {1, 2, 3, 6, 11, 40}) {
    const MatX a = drawn(n, n, 1), b = drawn(n, 2 * n, 2);
    MatX normal = MatX::Zero(n, n); // computed by explicit sums
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        for (Eigen::Index k = 0; k < 2 * n; ++k) normal(i, j) += b(i, k) * b(j, k);
    const double size = normal.cwiseAbs().maxCoeff();
    EXPECT_LT(farthest(product(b, b.transpose()), normal), 1e-13 * size);

    const SymmetricEigen eigen(normal);
    EXPECT_LT(
        farthest(eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose(), normal),
        1e-12 * size);
    for (Eigen::Index k = 1; k < n; ++k) EXPECT_LE(eigen.values[k - 1], eigen.values[k]);

    const SymmetricSolver solver(normal);
    const double condition = eigen.values[n - 1] / eigen.values[0];
    EXPECT_LT(farthest(normal * solver.inverse(), MatX::Identity(n, n)), 1e-14 * n * condition);
    EXPECT_LT(farthest(normal * solver.solve(a.col(0)), a.col(0)), 1e-13 * n * condition);
    EXPECT_LT(farthest(normal * solver.solveColumns(a), a), 1e-13 * n * condition);
    EXPECT_NEAR(solver.logDeterminant(), eigen.values.array().log().sum(), 1e-10 * n);
    EXPECT_GT(solver.reciprocalCondition(), 0);

    const Svd svd(b);
    MatX middle = MatX::Zero(n, 2 * n);
    middle.leftCols(n).diagonal() = svd.values;
    EXPECT_LT(farthest(svd.u * middle * svd.v.transpose(), b), 1e-12 * std::sqrt(size));
    EXPECT_LT(farthest(svd.v.transpose() * svd.v, MatX::Identity(2 * n, 2 * n)), 1e-13 * n);
  }
}

TEST(Decompose, DetectsSingularMatrices) {
  const Eigen::Vector3d a(1, 2, -1), b(0, 1, 3);
  const Eigen::Matrix3d flat = a * a.transpose() + b * b.transpose();
  EXPECT_LT(std::abs(SymmetricSolver(flat).reciprocalCondition()), 1e-15);
  EXPECT_LT(SymmetricSolver(-Eigen::Matrix3d(Vec3(-1, 1, 2).asDiagonal())).reciprocalCondition(),
            0);
}

TEST(Decompose, FindsComplexEigenvalues) {
  const double angle = 0.7;
  Eigen::Matrix3d turn(Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized()));
  double real = 0;
  for (const std::complex<double>& value : eigenvaluesOf(2 * turn)) {
    EXPECT_NEAR(std::abs(value), 2, 1e-14);
    real += value.real();
  }
  EXPECT_NEAR(real, 2 + 4 * std::cos(angle), 1e-14);
}

TEST(Decompose, RotatesOneDirectionToAnotherAlongTheShortestArc) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    const Vec3 a = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Vec3 b = i == 0 ? Vec3(-a) : Vec3(normal(random), normal(random), normal(random));
    const Eigen::Quaterniond turn = rotationFromTo(a, b);
    EXPECT_LT((turn * a - b.normalized()).norm(), 1e-12);
    EXPECT_NEAR(Eigen::AngleAxisd(turn).angle(), std::acos(a.dot(b.normalized())), 1e-7);
  }
}

} // namespace
} // namespace patina
