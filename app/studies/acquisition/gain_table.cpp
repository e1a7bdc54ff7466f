#include <algorithm>
#include <cmath>
#include <random>

#include "acquisition/filtering/motion_filter.h"
#include "app/studies/acquisition/filter_tables.h"

namespace patina {
namespace {

constexpr double kInterval = 0.02, kDeviation = 1e-3; // [s], [m]
constexpr int kSteps = 10000;

using One = Eigen::Matrix<double, 1, 1>;

One one(double value) {
  return One::Constant(value);
}

struct Run {
  Eigen::Vector2d gain;
  double nis = 0;
};

// A motion that is what the filter takes it for.
Run run(double index, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const double sigma = index * kDeviation / (kInterval * kInterval), R = kDeviation * kDeviation;
  const MotionStep<2> step = motionStep<2>(kInterval, sigma, ProcessNoise::held);
  const Eigen::Vector2d push(kInterval * kInterval / 2, kInterval);
  Eigen::Vector2d truth(0, 0.1 * normal(random));
  auto state = firstState<2, 1>(one(truth[0] + kDeviation * normal(random)), R, 0.1);
  Run result;
  for (int i = 0; i < kSteps; ++i) {
    truth = step.F * truth + push * (sigma * normal(random));
    predict(state, step);
    const Innovation<1> innovation =
        innovationOf(state, one(truth[0] + kDeviation * normal(random)), R);
    result.nis += innovation.nis() / kSteps;
    result.gain = update(state, innovation);
  }
  return result;
}

} // namespace

WorkPrecisionTable gainTable() {
  WorkPrecisionTable table =
      filterTable("Gains of constant velocity after 10,000 steps against the closed form (T-A06a), "
                  "relative, and the mean of squared innovations over their variance (T-A06b)",
                  "1");
  constexpr std::uint32_t kRuns = 20;
  const double band = 1.96 * std::sqrt(2. / kSteps);
  for (const double index : {0.01, 0.1, 1.}) {
    WorkPrecisionRow row;
    row.knobs = {{"index", index}};
    const SteadyGains known = steadyGains(index);
    double mean = 0, inside = 0;
    const double begin = threadSeconds();
    for (std::uint32_t seed = 1; seed <= kRuns; ++seed) {
      const Run found = run(index, seed);
      row.error = std::abs(found.gain[0] / known.alpha - 1);
      row.error_max = std::max(row.error, std::abs(found.gain[1] * kInterval / known.beta - 1));
      mean += found.nis / kRuns;
      inside += std::abs(found.nis - 1) < band;
    }
    row.ns = 1e9 * (threadSeconds() - begin) / (kRuns * kSteps);
    row.more = {{"NIS", mean}, {"runs of 20 in the 95 % band", inside}};
    table.rows.push_back(row);
  }
  return table;
}

} // namespace patina
