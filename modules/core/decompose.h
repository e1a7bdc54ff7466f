// Decompositions of dense matrices of any size, compiled here once: each of Eigen's is compiled
// anew for every size in every file that names it, which took a third of a build. They allocate:
// not for the servo, nor for a loop that solves millions.
#pragma once

#include <Eigen/Cholesky>

#include "core/types.h"

namespace patina {

using MatX = Eigen::MatrixXd;
using VecX = Eigen::VectorXd;
using MatrixView = Eigen::Ref<const MatX>; // of any size, fixed ones too, without a copy
using VectorView = Eigen::Ref<const VecX>;

// A = vectors diag(values) vectors^T; the lower half of A is read, and values ascend.
struct SymmetricEigen {
  explicit SymmetricEigen(const MatrixView& matrix);
  VecX values;
  MatX vectors;
};

// A = L D L^T with pivots, of a symmetric A: for normal equations.
class SymmetricSolver {
 public:
  explicit SymmetricSolver(const MatrixView& matrix);
  VecX solve(const VectorView& right) const;
  MatX solveColumns(const MatrixView& right) const;
  MatX inverse() const; // of no use where A is singular: see evenness()
  // The least pivot over the largest size of one: 0 where A is singular or nothing, negative where
  // it is not positive.
  double evenness() const;
  double logDeterminant() const;

 private:
  Eigen::LDLT<MatX> ldlt_;
};

Eigen::VectorXcd eigenvaluesOf(const MatrixView& matrix); // of any square matrix, in no order
MatX product(const MatrixView& a, const MatrixView& b);

// A = u diag(values) v^T, u and v square; values descend.
struct Svd {
  explicit Svd(const MatrixView& matrix);
  MatX u, v;
  VecX values;
};

// The shortest turn from one direction to another; Eigen's brings an SVD along.
Eigen::Quaterniond turnFromTo(const Vec3& from, const Vec3& to);

} // namespace patina
