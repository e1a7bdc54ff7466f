// The library that holds Ceres, on problems with known solutions.
#include <stdexcept>

#include <gtest/gtest.h>

#include "acquisition/loaded/solver_library.h"
#include "core/decompose.h"

namespace patina {
namespace {

// Values at four times of a straight line: its height at 0 and its slope.
LeastSquares lineThrough(const std::vector<double>& heights) {
  LeastSquares task;
  task.values = 2;
  task.residuals = static_cast<int>(heights.size());
  task.evaluate = [heights](const double* line, double* residuals, double* slopes) {
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const auto t = static_cast<double>(i);
      residuals[i] = line[0] + line[1] * t - heights[i];
      if (!slopes) continue;
      slopes[2 * i] = 1;
      slopes[2 * i + 1] = t;
    }
  };
  return task;
}

TEST(SolverLibrary, LineFitMatchesTheNormalEquations) {
  const LeastSquares task = lineThrough({1, 3, 4, 8});
  std::vector<double> line(2), covariance;
  LeastSquaresSteps steps;
  ASSERT_EQ(solverLibrary().solve(task, line, steps), "");
  EXPECT_TRUE(steps.settled);
  EXPECT_NEAR(line[0], 0.7, 1e-6);
  EXPECT_NEAR(line[1], 2.2, 1e-6);
  ASSERT_EQ(solverLibrary().covariance(task, line, covariance), "");
  const MatX expected = (MatX(2, 2) << 0.7, -0.3, -0.3, 0.2).finished();
  EXPECT_LT((Eigen::Map<const MatX>(covariance.data(), 2, 2) - expected).norm(), 1e-12);
  // At the solution no step is left.
  ASSERT_EQ(solverLibrary().solve(task, line, steps), "");
  EXPECT_EQ(steps.taken, 0);
}

// Rosenbrock's valley, from its usual starting point.
TEST(SolverLibrary, FollowsACurvedValleyToItsEnd) {
  LeastSquares task;
  task.values = task.residuals = 2;
  task.evaluate = [](const double* p, double* residuals, double* slopes) {
    residuals[0] = 10 * (p[1] - p[0] * p[0]);
    residuals[1] = 1 - p[0];
    if (!slopes) return;
    slopes[0] = -20 * p[0];
    slopes[1] = 10;
    slopes[2] = -1;
    slopes[3] = 0;
  };
  std::vector<double> place{-1.2, 1};
  LeastSquaresSteps steps;
  task.max_steps = 3;
  ASSERT_EQ(solverLibrary().solve(task, place, steps), "");
  EXPECT_FALSE(steps.settled);
  task.max_steps = 50;
  ASSERT_EQ(solverLibrary().solve(task, place, steps), "");
  EXPECT_TRUE(steps.settled);
  EXPECT_GT(steps.taken, 1);
  EXPECT_NEAR(place[0], 1, 1e-6);
  EXPECT_NEAR(place[1], 1, 1e-6);
}

TEST(SolverLibrary, ReportsFailureWithoutConsoleOutput) {
  testing::internal::CaptureStderr();
  std::vector<double> values{1, 2}, covariance;
  LeastSquaresSteps steps;
  // Two values of which only the sum is observable.
  LeastSquares task = lineThrough({1, 3});
  task.evaluate = [](const double* p, double* residuals, double* slopes) {
    residuals[0] = residuals[1] = p[0] + p[1] - 7;
    if (slopes) std::fill(slopes, slopes + 4, 1.0);
  };
  EXPECT_EQ(solverLibrary().solve(task, values, steps), "");
  EXPECT_NEAR(values[0] + values[1], 7, 1e-6);
  EXPECT_NE(solverLibrary().covariance(task, values, covariance), "");
  task.evaluate = [](const double*, double* residuals, double*) {
    residuals[0] = residuals[1] = std::nan("");
  };
  EXPECT_EQ(solverLibrary().solve(task, values, steps), "");
  EXPECT_FALSE(steps.settled);
  EXPECT_NEAR(values[0] + values[1], 7, 1e-6); // the values stay
  task.evaluate = [](const double*, double*, double*) { throw std::runtime_error("no residuals"); };
  EXPECT_EQ(solverLibrary().solve(task, values, steps), "no residuals");
  // A problem without parameters is solved.
  task.values = 0;
  values.clear();
  EXPECT_EQ(solverLibrary().solve(task, values, steps), "");
  EXPECT_TRUE(steps.settled);
  EXPECT_EQ(solverLibrary().covariance(task, values, covariance), "");
  EXPECT_TRUE(covariance.empty());
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// Two lines with a common slope: their heights at 0 are eliminated, or one is held.
TEST(SolverLibrary, SparseFitMatchesTheNormalEquations) {
  const std::vector<double> y{1, 3, 4, 8, 2, 2.5, 5, 5};
  SparseLeastSquares task;
  for (int block = 0; block < 3; ++block) {
    task.blocks.emplace_back();
    task.blocks.back().first = block;
    task.blocks.back().size = 1;
    task.blocks.back().eliminated = block > 0;
  }
  MatX design = MatX::Zero(8, 3);
  for (int i = 0; i < 8; ++i) {
    const double t = i % 4, height = y[static_cast<std::size_t>(i)];
    design(i, 0) = t;
    design(i, 1 + i / 4) = 1;
    SparseLeastSquares::Term term;
    term.blocks = {0, 1 + i / 4};
    term.residuals = 1;
    term.evaluate = [t, height](const double* const* at, double* residuals, double* const* slopes) {
      residuals[0] = at[0][0] * t + at[1][0] - height;
      if (slopes && slopes[0]) slopes[0][0] = t;
      if (slopes && slopes[1]) slopes[1][0] = 1;
      return true;
    };
    task.terms.push_back(term);
  }
  task.settled = 1e-14;
  std::vector<double> values(3), covariance;
  LeastSquaresSteps steps;
  ASSERT_EQ(solverLibrary().solveSparse(task, values, steps), "");
  EXPECT_TRUE(steps.settled);
  const MatX normal = design.transpose() * design;
  const VecX expected =
      SymmetricSolver(normal).solve(design.transpose() * Eigen::Map<const VecX>(y.data(), 8));
  EXPECT_LT((Eigen::Map<const VecX>(values.data(), 3) - expected).norm(), 1e-5);
  ASSERT_EQ(solverLibrary().sparseCovariance(task, values, {0, 2}, covariance), "");
  const MatX inverse = SymmetricSolver(normal).inverse();
  EXPECT_NEAR(covariance[0], inverse(0, 0), 1e-12);
  EXPECT_NEAR(covariance[1], inverse(0, 2), 1e-12);
  EXPECT_NEAR(covariance[3], inverse(2, 2), 1e-12);

  task.blocks[2].held = true;
  values[2] = 7;
  ASSERT_EQ(solverLibrary().solveSparse(task, values, steps), "");
  EXPECT_EQ(values[2], 7);
  // An outlier hardly moves a robust fit.
  task.blocks[2].held = false;
  for (SparseLeastSquares::Term& term : task.terms) term.robust = 0.1;
  task.terms.push_back(task.terms[0]);
  task.terms.back().evaluate = [](const double* const* at, double* residuals,
                                  double* const* slopes) {
    residuals[0] = at[1][0] - 1000;
    if (slopes && slopes[0]) slopes[0][0] = 0;
    if (slopes && slopes[1]) slopes[1][0] = 1;
    return true;
  };
  ASSERT_EQ(solverLibrary().solveSparse(task, values, steps), "");
  EXPECT_LT(std::abs(values[1] - expected[1]), 1);
}

} // namespace
} // namespace patina
