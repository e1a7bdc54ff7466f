#include "core/decompose.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace patina {

SymmetricEigen::SymmetricEigen(const MatrixView& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatX> solver(matrix);
  values = solver.eigenvalues();
  vectors = solver.eigenvectors();
}

SymmetricSolver::SymmetricSolver(const MatrixView& matrix) : ldlt_(matrix) {}

VecX SymmetricSolver::solve(const VectorView& rhs) const {
  return ldlt_.solve(rhs);
}

MatX SymmetricSolver::solveColumns(const MatrixView& rhs) const {
  return ldlt_.solve(rhs);
}

MatX SymmetricSolver::inverse() const {
  return ldlt_.solve(MatX::Identity(ldlt_.rows(), ldlt_.cols()));
}

double SymmetricSolver::reciprocalCondition() const {
  const double most = ldlt_.vectorD().cwiseAbs().maxCoeff();
  return most > 0 ? ldlt_.vectorD().minCoeff() / most : 0;
}

double SymmetricSolver::logDeterminant() const {
  return ldlt_.vectorD().array().log().sum();
}

Eigen::VectorXcd eigenvaluesOf(const MatrixView& matrix) {
  return Eigen::EigenSolver<MatX>(matrix, false).eigenvalues();
}

MatX product(const MatrixView& a, const MatrixView& b) {
  return a * b;
}

Svd::Svd(const MatrixView& matrix) {
  // Divide and conquer would be faster from some hundred columns on, but takes far longer to
  // compile; 257 by 257 take 0.17 s.
  const Eigen::JacobiSVD<MatX> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  u = svd.matrixU();
  v = svd.matrixV();
  values = svd.singularValues();
}

Eigen::Quaterniond rotationFromTo(const Vec3& from, const Vec3& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

} // namespace patina
