// Interface of the library with Ceres, which is loaded at the first joint fit or adjustment. Both
// sides are built together, so that C++ types may be passed; exceptions may not.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace patina {

// A nonlinear least-squares problem.
struct LeastSquares {
  int values = 0, residuals = 0;
  // Computes the residuals and, unless nullptr, their derivatives by the values, row by residual.
  std::function<void(const double* values, double* residuals, double* slopes)> evaluate;
  double settled = 1e-6; // relative tolerance of the sum of squares
  int max_steps = 50;
};

struct LeastSquaresSteps {
  int taken = 0, tried = 0;
  bool settled = false;
};

// A nonlinear least-squares problem in which each group of residuals depends on few blocks of
// values.
struct SparseLeastSquares {
  struct Block {
    int first = 0, size = 0; // its part of the values
    bool held = false;       // the block stays as it is
    // The block is eliminated from the normal equations (Schur complement): no term has two of
    // them.
    bool eliminated = false;
  };
  struct Term {
    std::vector<int> blocks;
    int residuals = 0;
    // Computes residuals and, unless nullptr, their derivatives by each block, row by residual; a
    // block's derivatives may be nullptr too. `values` has a pointer for each block. Returns false
    // if there are none.
    std::function<bool(const double* const* values, double* residuals, double* const* slopes)>
        evaluate;
    double robust = 0; // scale of Cauchy's loss of the residuals' norm; 0: their square
  };
  std::vector<Block> blocks;
  std::vector<Term> terms;
  double settled = 1e-6; // relative tolerance of the sum of losses
  int max_steps = 50;
};

// Each function returns an empty text, or the cause of the failure.
struct SolverLibrary {
  std::string (*solve)(const LeastSquares&, std::vector<double>& values, LeastSquaresSteps& steps);
  // Covariance of the values, row by row, for residuals with a deviation of 1.
  std::string (*covariance)(const LeastSquares&, std::vector<double> values,
                            std::vector<double>& covariance);
  std::string (*solveSparse)(const SparseLeastSquares&, std::vector<double>& values,
                             LeastSquaresSteps& steps);
  // Covariance of the values of some blocks that are not held, row by row. Robust terms count with
  // their weights at the solution.
  std::string (*sparseCovariance)(const SparseLeastSquares&, std::vector<double> values,
                                  const std::vector<int>& blocks, std::vector<double>& covariance);
};

// The only symbol that is looked up.
inline constexpr const char* kSolverLibrarySymbol = "patinaSolverLibrary";
using SolverLibraryFunction = const SolverLibrary*();

} // namespace patina
