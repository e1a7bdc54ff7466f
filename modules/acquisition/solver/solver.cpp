#include "acquisition/solver/solver.h"

#include <ceres/ceres.h>
#include <exception>
#include <limits>

namespace patina {
namespace {

// All residuals at once: they share what was worked out for the values.
class Residuals : public ceres::CostFunction {
 public:
  explicit Residuals(const LeastSquares& task) : task_(task) {
    set_num_residuals(task.residuals);
    mutable_parameter_block_sizes()->push_back(task.values);
  }
  bool Evaluate(double const* const* values, double* residuals, double** slopes) const override {
    task_.evaluate(values[0], residuals, slopes ? slopes[0] : nullptr);
    const double sum = Eigen::Map<const Eigen::VectorXd>(residuals, task_.residuals).squaredNorm();
    if (sum < least_) {
      least_ = sum;
      best_.assign(values[0], values[0] + task_.values);
    }
    return std::isfinite(sum);
  }
  const std::vector<double>& best() const { return best_; } // of the values that were tried

 private:
  const LeastSquares& task_;
  mutable double least_ = std::numeric_limits<double>::infinity();
  mutable std::vector<double> best_;
};

// Nothing that is thrown, not even for want of memory, may leave the library.
template <typename Work> std::string guarded(const Work& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "Ceres failed";
  }
}

ceres::Problem::Options borrowing() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

std::string solve(const LeastSquares& task, std::vector<double>& values, LeastSquaresSteps& steps) {
  return guarded([&]() -> std::string {
    steps = {0, 0, true};
    if (values.empty()) return "";
    Residuals residuals(task);
    ceres::Problem problem(borrowing());
    problem.AddResidualBlock(&residuals, nullptr, values.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = task.most_steps;
    options.function_tolerance = task.settled;
    // Only what a step gains ends it, whatever the values' units.
    options.gradient_tolerance = options.parameter_tolerance = 0;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    // The last step gains less than what counts, and Ceres leaves it out; it has been paid for.
    if (!residuals.best().empty()) values = residuals.best();
    for (const ceres::IterationSummary& each : summary.iterations)
      steps.taken += each.iteration > 0 && each.step_is_successful;
    steps.tried = static_cast<int>(summary.iterations.size());
    steps.settled = summary.termination_type == ceres::CONVERGENCE;
    return "";
  });
}

std::string covariance(const LeastSquares& task, std::vector<double> values,
                       std::vector<double>& covariance) {
  return guarded([&]() -> std::string {
    covariance.assign(values.size() * values.size(), 0);
    if (values.empty()) return "";
    Residuals residuals(task);
    ceres::Problem problem(borrowing());
    problem.AddResidualBlock(&residuals, nullptr, values.data());
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    options.num_threads = 1;
    ceres::Covariance found(options);
    const std::vector<std::pair<const double*, const double*>> all{{values.data(), values.data()}};
    if (!found.Compute(all, &problem) ||
        !found.GetCovarianceBlock(values.data(), values.data(), covariance.data()))
      return "the residuals do not tell all of the values";
    return "";
  });
}

} // namespace

extern "C" __attribute__((visibility("default"))) const SolverLibrary* patinaSolverLibrary() {
  static constexpr SolverLibrary kLibrary{solve, covariance};
  FLAGS_minloglevel = google::GLOG_FATAL; // what it says on the console the results say
  return &kLibrary;
}

} // namespace patina
