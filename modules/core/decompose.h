// Decompositions of dense matrices of any size, compiled only here: Eigen's templates would be
// compiled for every size in every file, a third of the build time. They allocate memory, so the
// servo and inner loops must not call them.
#pragma once

#include <Eigen/Cholesky>

#include "core/types.h"

namespace patina {

using MatX = Eigen::MatrixXd;
using VecX = Eigen::VectorXd;
using MatrixView = Eigen::Ref<const MatX>; // any size, also fixed; no copy
using VectorView = Eigen::Ref<const VecX>;

// A = vectors diag(values) vectors^T. Reads the lower half of A; values ascend.
struct SymmetricEigen {
  explicit SymmetricEigen(const MatrixView& matrix);
  VecX values;
  MatX vectors;
};

// Pivoted A = L D L^T of a symmetric A, for normal equations.
class SymmetricSolver {
 public:
  explicit SymmetricSolver(const MatrixView& matrix);
  VecX solve(const VectorView& rhs) const;
  MatX solveColumns(const MatrixView& rhs) const;
  MatX inverse() const; // meaningless for a singular A: see reciprocalCondition()
  // Smallest pivot over the largest absolute pivot, an estimate of the reciprocal condition: 0 if A
  // is singular or empty, negative if A is not positive definite.
  double reciprocalCondition() const;
  double logDeterminant() const;

 private:
  Eigen::LDLT<MatX> ldlt_;
};

Eigen::VectorXcd eigenvaluesOf(const MatrixView& matrix); // any square matrix; unordered
MatX product(const MatrixView& a, const MatrixView& b);

// A = u diag(values) v^T with square u and v; values descend.
struct Svd {
  explicit Svd(const MatrixView& matrix);
  MatX u, v;
  VecX values;
};

// Shortest-arc rotation; compiled here because Eigen's FromTwoVectors instantiates an SVD.
Eigen::Quaterniond rotationFromTo(const Vec3& from, const Vec3& to);

} // namespace patina
