#include "acquisition/loaded/solver.h"

#include <ceres/ceres.h>
#include <exception>
#include <limits>

namespace patina {
namespace {

// All residuals in one cost function, which share intermediate results.
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
  const std::vector<double>& best() const { return best_; } // best values tried

 private:
  const LeastSquares& task_;
  mutable double least_ = std::numeric_limits<double>::infinity();
  mutable std::vector<double> best_;
};

// No exception, not even std::bad_alloc, may leave the library.
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

ceres::Solver::Options solverOptions(double settled, int max_steps) {
  ceres::Solver::Options options;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = max_steps;
  options.function_tolerance = settled;
  // Only the gain of a step ends the fit, independent of the values' units.
  options.gradient_tolerance = options.parameter_tolerance = 0;
  return options;
}

std::string solve(const LeastSquares& task, std::vector<double>& values, LeastSquaresSteps& steps) {
  return guarded([&]() -> std::string {
    steps = {0, 0, true};
    if (values.empty()) return "";
    Residuals residuals(task);
    ceres::Problem problem(borrowing());
    problem.AddResidualBlock(&residuals, nullptr, values.data());
    ceres::Solver::Options options = solverOptions(task.settled, task.max_steps);
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    // Ceres discards the last step if it gains less than the tolerance; it is kept here.
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
      return "the residuals do not determine all values";
    return "";
  });
}

// One term of a sparse problem.
class TermResiduals : public ceres::CostFunction {
 public:
  TermResiduals(const SparseLeastSquares& task, const SparseLeastSquares::Term& term)
      : term_(term) {
    set_num_residuals(term.residuals);
    for (const int block : term.blocks)
      mutable_parameter_block_sizes()->push_back(task.blocks[static_cast<std::size_t>(block)].size);
  }
  bool Evaluate(double const* const* values, double* residuals, double** slopes) const override {
    return term_.evaluate(values, residuals, slopes) &&
           Eigen::Map<const Eigen::VectorXd>(residuals, term_.residuals).allFinite();
  }

 private:
  const SparseLeastSquares::Term& term_;
};

// Adds the blocks and terms of a sparse problem, of which the problem becomes the owner.
void fill(ceres::Problem& problem, const SparseLeastSquares& task, std::vector<double>& values) {
  for (const SparseLeastSquares::Block& block : task.blocks) {
    problem.AddParameterBlock(values.data() + block.first, block.size);
    if (block.held) problem.SetParameterBlockConstant(values.data() + block.first);
  }
  for (const SparseLeastSquares::Term& term : task.terms) {
    std::vector<double*> places;
    for (const int block : term.blocks)
      places.push_back(values.data() + task.blocks[static_cast<std::size_t>(block)].first);
    problem.AddResidualBlock(new TermResiduals(task, term),
                             term.robust > 0 ? new ceres::CauchyLoss(term.robust) : nullptr,
                             places);
  }
}

std::string solveSparse(const SparseLeastSquares& task, std::vector<double>& values,
                        LeastSquaresSteps& steps) {
  return guarded([&]() -> std::string {
    ceres::Problem problem;
    fill(problem, task, values);
    ceres::Solver::Options options = solverOptions(task.settled, task.max_steps);
    options.linear_solver_type = ceres::SPARSE_SCHUR;
    options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (const SparseLeastSquares::Block& block : task.blocks)
      options.linear_solver_ordering->AddElementToGroup(values.data() + block.first,
                                                        block.eliminated ? 0 : 1);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    steps = {summary.num_successful_steps, static_cast<int>(summary.iterations.size()),
             summary.termination_type == ceres::CONVERGENCE};
    return summary.IsSolutionUsable() ? "" : summary.message;
  });
}

std::string sparseCovariance(const SparseLeastSquares& task, std::vector<double> values,
                             const std::vector<int>& blocks, std::vector<double>& covariance) {
  return guarded([&]() -> std::string {
    ceres::Problem problem;
    fill(problem, task, values);
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::SPARSE_QR;
    options.num_threads = 1;
    ceres::Covariance found(options);
    std::vector<const double*> places;
    int size = 0;
    for (const int block : blocks) {
      const SparseLeastSquares::Block& each = task.blocks[static_cast<std::size_t>(block)];
      places.push_back(values.data() + each.first);
      size += each.size;
    }
    covariance.assign(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0);
    if (places.empty()) return "";
    if (!found.Compute(places, &problem) || !found.GetCovarianceMatrix(places, covariance.data()))
      return "the residuals do not determine all values";
    return "";
  });
}

} // namespace

extern "C" __attribute__((visibility("default"))) const SolverLibrary* patinaSolverLibrary() {
  static constexpr SolverLibrary kLibrary{solve, covariance, solveSparse, sparseCovariance};
  FLAGS_minloglevel = google::GLOG_FATAL; // the results contain its messages
  return &kLibrary;
}

} // namespace patina
