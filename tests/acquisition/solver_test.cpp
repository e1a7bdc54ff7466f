// The library that holds Ceres, by problems whose answers are known.
#include <stdexcept>

#include <gtest/gtest.h>

#include "acquisition/solver_library.h"
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

TEST(SolverLibrary, ALineIsThatOfTheNormalEquations) {
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
  // From where it is there is no step left to take.
  ASSERT_EQ(solverLibrary().solve(task, line, steps), "");
  EXPECT_EQ(steps.taken, 0);
}

// Rosenbrock's valley, from the place that all begin at.
TEST(SolverLibrary, ABentValleyIsFollowedToItsEnd) {
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
  task.most_steps = 3;
  ASSERT_EQ(solverLibrary().solve(task, place, steps), "");
  EXPECT_FALSE(steps.settled);
  task.most_steps = 50;
  ASSERT_EQ(solverLibrary().solve(task, place, steps), "");
  EXPECT_TRUE(steps.settled);
  EXPECT_GT(steps.taken, 1);
  EXPECT_NEAR(place[0], 1, 1e-6);
  EXPECT_NEAR(place[1], 1, 1e-6);
}

TEST(SolverLibrary, WhatCannotBeSolvedIsSaidAndNotOnTheConsole) {
  testing::internal::CaptureStderr();
  std::vector<double> values{1, 2}, covariance;
  LeastSquaresSteps steps;
  // Two values of which only the sum is told.
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
  EXPECT_NEAR(values[0] + values[1], 7, 1e-6); // they stay
  task.evaluate = [](const double*, double*, double*) { throw std::runtime_error("no residuals"); };
  EXPECT_EQ(solverLibrary().solve(task, values, steps), "no residuals");
  // Nothing to find is found.
  task.values = 0;
  values.clear();
  EXPECT_EQ(solverLibrary().solve(task, values, steps), "");
  EXPECT_TRUE(steps.settled);
  EXPECT_EQ(solverLibrary().covariance(task, values, covariance), "");
  EXPECT_TRUE(covariance.empty());
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

} // namespace
} // namespace patina
