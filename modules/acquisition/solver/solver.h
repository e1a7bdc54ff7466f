// What the program asks of the library that holds Ceres, which it loads with the first joint fit.
// Both sides are built together, so that C++ types may cross; exceptions may not.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace patina {

// Values whose residuals have the least sum of squares.
struct LeastSquares {
  int values = 0, residuals = 0;
  // The residuals and, unless it is nullptr, how each grows with each value, residual by residual.
  std::function<void(const double* values, double* residuals, double* slopes)> evaluate;
  double settled = 1e-6; // of the sum: a step that gains less is the last one
  int most_steps = 50;
};

struct LeastSquaresSteps {
  int taken = 0, tried = 0;
  bool settled = false;
};

// Each returns an empty text, or why it could not.
struct SolverLibrary {
  // From the values that are given.
  std::string (*solve)(const LeastSquares&, std::vector<double>& values, LeastSquaresSteps& steps);
  // Of the values, row by row, where residuals have a deviation of 1.
  std::string (*covariance)(const LeastSquares&, std::vector<double> values,
                            std::vector<double>& covariance);
};

// The one symbol that is looked up.
inline constexpr const char* kSolverLibrarySymbol = "patinaSolverLibrary";
using SolverLibraryFunction = const SolverLibrary*();

} // namespace patina
