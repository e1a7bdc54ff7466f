#include "acquisition/filtering/motion_filter.h"
#include "core/decompose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Dense>

namespace patina {
namespace {

using One = Eigen::Matrix<double, 1, 1>;

One one(double value) {
  return One::Constant(value);
}

// Steady-state gains of the constant-velocity filter with piecewise constant noise, in closed form:
// alpha of the position, beta / dt of the velocity. `index` is sigma dt^2 / sigma_measured.
struct SteadyGains {
  double alpha, beta;
};
SteadyGains steadyGains(double index) {
  // r = (4 + index - sqrt(8 index + index^2)) / 4 without cancellation.
  const double root = std::sqrt(index * (8 + index));
  const double lost = 2 * index / (root + index); // 1 - r, as (root - index) / 4
  return {lost * (2 - lost), 2 * lost * lost};
}

// T-A06a, values of the closed form.
TEST(MotionFilter, SettlesToTheGainsOfTheClosedForm) {
  const struct {
    double index, alpha, beta;
  } known[] = {{0.01, 0.131850991, 0.009317451}, {0.1, 0.36, 0.08}, {1, 0.75, 0.5}};
  for (const auto& [index, alpha, beta] : known) {
    const double dt = 0.04, variance = 1e-6;
    const double sigma = index * std::sqrt(variance) / (dt * dt);
    EXPECT_NEAR(steadyGains(index).alpha, alpha, 1e-9);
    EXPECT_NEAR(steadyGains(index).beta, beta, 1e-9);
    auto state = firstState<2, 1>(one(0), variance, 1);
    Eigen::Vector2d gain;
    for (int i = 0; i < 3000; ++i) {
      predict(state, motionStep<2>(dt, sigma, ProcessNoise::piecewise_constant));
      gain = update(state, innovationOf(state, one(0.1 * i), variance));
    }
    EXPECT_NEAR(gain[0], steadyGains(index).alpha, 1e-9 * gain[0]) << index;
    EXPECT_NEAR(gain[1] * dt, steadyGains(index).beta, 1e-9 * gain[1] * dt) << index;
    EXPECT_NEAR(state.P(0, 0) / variance, steadyGains(index).alpha, 1e-9) << index;
  }
}

struct Run {
  double nis = 0, nees = 0;
};

// A motion that matches the filter's model.
Run consistentRun(int steps, std::uint32_t seed, double told = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const double dt = 0.02, sigma = 3, deviation = 1e-3, speed = 0.5;
  const MotionStep<2> step = motionStep<2>(dt, sigma, ProcessNoise::piecewise_constant);
  Eigen::Vector2d truth(0.3, speed * normal(random));
  const double variance = told * deviation * deviation;
  auto state = firstState<2, 1>(one(truth[0] + deviation * normal(random)), variance, speed);
  Run run;
  for (int i = 0; i < steps; ++i) {
    truth = step.F * truth + Eigen::Vector2d(dt * dt / 2, dt) * (sigma * normal(random));
    predict(state, step);
    const Innovation<1> innovation =
        innovationOf(state, one(truth[0] + deviation * normal(random)), variance);
    run.nis += innovation.nis() / steps;
    update(state, innovation);
  }
  const Eigen::Vector2d error = state.x - truth;
  run.nees = error.dot(state.P.inverse() * error);
  return run;
}

// T-A06b: 10,000 innovations are independent, of chi^2 with one degree of freedom. One run in
// twenty may lie outside the band; the band of the mean over all runs is narrower.
TEST(MotionFilter, InnovationsHaveTheStatedVariance) {
  constexpr int kRuns = 20;
  const double band = 1.96 * std::sqrt(2. / 10000);
  double mean = 0;
  int inside = 0;
  for (std::uint32_t run = 1; run <= kRuns; ++run) {
    const double nis = consistentRun(10000, run).nis;
    mean += nis / kRuns;
    inside += std::abs(nis - 1) < band;
  }
  EXPECT_GE(inside, 17);
  EXPECT_NEAR(mean, 1, 1.5 * band / std::sqrt(kRuns));
  EXPECT_GT(std::abs(consistentRun(10000, 5, 0.8).nis - 1), band) << "a wrong sigma must show";
}

TEST(MotionFilter, ErrorsHaveTheStatedVariance) {
  constexpr int kRuns = 2000;
  double nees = 0;
  for (std::uint32_t run = 0; run < kRuns; ++run)
    nees += consistentRun(40, 1000 + run).nees / kRuns;
  EXPECT_NEAR(nees, 2, 1.96 * 2 / std::sqrt(kRuns));
}

// T-A06c.
TEST(MotionFilter, FindsAMotionWithoutNoiseExactly) {
  auto state = firstState<2, 1>(one(1), 1e-6, 1);
  for (int i = 1; i <= 400; ++i) {
    predict(state, motionStep<2>(0.01, 1e-4, ProcessNoise::continuous_white));
    update(state, innovationOf(state, one(1 + 0.25 * 0.01 * i), 1e-6));
  }
  EXPECT_NEAR(state.x(0, 0), 2, 1e-7);
  EXPECT_NEAR(state.x(1, 0), 0.25, 1e-6);
}

// T-A06d: steps of 0.15 m/s^2 alone drift by a millimetre in a second.
TEST(MotionFilter, DriftMatchesTheClosedFormWithoutACamera) {
  const double rate = 500, noise = 0.0425;
  MotionState<2, 1> state;
  for (int i = 0; i < 500; ++i)
    predict(state,
            motionStep<2>(1 / rate, noise / std::sqrt(rate), ProcessNoise::continuous_white));
  EXPECT_NEAR(std::sqrt(state.P(0, 0)), noise * std::sqrt(1 / rate) / std::sqrt(3.), 1e-12);
  EXPECT_NEAR(std::sqrt(state.P(0, 0)), 1.1e-3, 0.01e-3);
}

TEST(MotionFilter, WhiteNoiseDoesNotDependOnTheStepSize) {
  const MotionStep<3> whole = motionStep<3>(0.03, 7, ProcessNoise::continuous_white);
  const MotionStep<3> first = motionStep<3>(0.01, 7, ProcessNoise::continuous_white);
  const MotionStep<3> second = motionStep<3>(0.02, 7, ProcessNoise::continuous_white);
  EXPECT_TRUE((second.F * first.F).isApprox(whole.F, 1e-14));
  EXPECT_TRUE((second.F * first.Q * second.F.transpose() + second.Q).isApprox(whole.Q, 1e-12));
}

struct Smoother {
  std::vector<MotionState<3, 1>> filtered, predicted, smooth;
  std::vector<Eigen::Matrix3d> gains;
};

// `variance` below 0: no measurement there.
Smoother smoothedOver(const std::vector<double>& times, const std::vector<double>& values,
                      const std::vector<double>& variances, double sigma,
                      const MotionState<3, 1>& begin) {
  Smoother s;
  for (std::size_t i = 0; i < times.size(); ++i) {
    MotionState<3, 1> state = i ? s.filtered.back() : begin;
    if (i)
      predict(state, motionStep<3>(times[i] - times[i - 1], sigma, ProcessNoise::continuous_white));
    s.predicted.push_back(state);
    if (variances[i] >= 0) update(state, innovationOf(state, one(values[i]), variances[i]));
    s.filtered.push_back(state);
  }
  s.smooth = s.filtered;
  s.gains.resize(times.size(), Eigen::Matrix3d::Zero());
  for (std::size_t i = times.size() - 1; i-- > 0;) {
    s.gains[i] = smootherGain<3>(
        s.filtered[i].P, s.predicted[i + 1].P,
        motionStep<3>(times[i + 1] - times[i], sigma, ProcessNoise::continuous_white));
    s.smooth[i] = smoothed<3, 1>(s.filtered[i], s.predicted[i + 1], s.smooth[i + 1], s.gains[i]);
  }
  return s;
}

MotionState<3, 1> anyBegin() {
  MotionState<3, 1> begin;
  begin.P.diagonal() << 1e-2, 1, 10;
  return begin;
}

// The oracle is one least-squares problem over all states at once.
TEST(MotionFilter, SmootherAgreesWithBatchLeastSquares) {
  const std::vector<double> times{0, 0.03, 0.05, 0.2, 0.21, 0.4}, values{1, 2, -1, 0.5, 3, 1};
  const std::vector<double> variances{0.01, 0.02, 0.01, 0.03, 0.01, 0.01};
  const double sigma = 5;
  const MotionState<3, 1> begin = anyBegin();
  const auto n = static_cast<Eigen::Index>(times.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * n);
  normal.topLeftCorner<3, 3>() += begin.P.inverse();
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    normal(3 * i, 3 * i) += 1 / variances[at];
    right[3 * i] += values[at] / variances[at];
    if (i == 0) continue;
    const MotionStep<3> step =
        motionStep<3>(times[at] - times[at - 1], sigma, ProcessNoise::continuous_white);
    Eigen::Matrix<double, 3, 6> link;
    link << -step.F, Eigen::Matrix3d::Identity();
    normal.block<6, 6>(3 * (i - 1), 3 * (i - 1)) += link.transpose() * step.Q.inverse() * link;
  }
  const Eigen::VectorXd x = SymmetricSolver(normal).solve(right);
  const Eigen::MatrixXd P = SymmetricSolver(normal).inverse();
  const Smoother s = smoothedOver(times, values, variances, sigma, begin);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& state = s.smooth[static_cast<std::size_t>(i)];
    EXPECT_TRUE(state.x.isApprox(x.segment<3>(3 * i), 1e-6)) << i;
    EXPECT_TRUE(state.P.isApprox(P.block<3, 3>(3 * i, 3 * i), 1e-6)) << i;
  }
}

TEST(MotionFilter, InterpolationAgreesWithTheSmoother) {
  const double sigma = 5;
  const Smoother with = smoothedOver({0, 0.1, 0.13, 0.2, 0.3}, {1, 2, 0, -1, 0.5},
                                     {0.01, 0.02, -1, 0.01, 0.03}, sigma, anyBegin());
  const Smoother without = smoothedOver({0, 0.1, 0.2, 0.3}, {1, 2, -1, 0.5},
                                        {0.01, 0.02, 0.01, 0.03}, sigma, anyBegin());
  const MotionState<3, 1> state =
      between<3, 1>(without.smooth[1], without.smooth[2], without.gains[1], 0.03, 0.07, sigma);
  EXPECT_TRUE(state.x.isApprox(with.smooth[2].x, 1e-9));
  EXPECT_TRUE(state.P.isApprox(with.smooth[2].P, 1e-9));
}

// Extremes of the Kalman filter.
TEST(MotionFilter, TakesExactMeasurementsAndCertainMotions) {
  auto state = firstState<3, 1>(one(0), 0, 1);
  for (int i = 1; i < 50; ++i) {
    predict(state, motionStep<3>(0.01, 0, ProcessNoise::continuous_white));
    update(state, innovationOf(state, one(0.02 * i), 0));
    ASSERT_TRUE(state.x.allFinite() && state.P.allFinite()) << i;
    ASSERT_GE(state.P.diagonal().minCoeff(), 0) << i;
    ASSERT_EQ(state.P(0, 0), 0) << i;
  }
  EXPECT_NEAR(state.x(0, 0), 0.98, 1e-9);
  // Nothing is uncertain, and the same value is measured again at the same time.
  MotionState<3, 1> certain;
  predict(certain, motionStep<3>(0, 1, ProcessNoise::continuous_white));
  update(certain, innovationOf(certain, one(5), 0));
  EXPECT_EQ(certain.x, (Eigen::Matrix<double, 3, 1>::Zero()));
  EXPECT_TRUE(
      (smootherGain<3>(certain.P, certain.P, motionStep<3>(0, 0, ProcessNoise::continuous_white))
           .allFinite()));
}

TEST(MotionFilter, StaysSymmetricAndPositiveForAMillionSteps) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> jitter(1e-4, 4e-3);
  auto state = firstState<3, 1>(one(0), 1e-8, 1);
  for (int i = 0; i < 1000000; ++i) {
    predict(state,
            motionStep<3>(i % 5000 == 0 ? 2 : jitter(random), 1, ProcessNoise::continuous_white));
    const double outlier = i % 33 == 0 ? 1 : 0;
    update(state, innovationOf(state, one(1e-4 * normal(random) + outlier), 1e-8));
    if (i % 1000 != 0) continue;
    ASSERT_EQ(state.P, state.P.transpose()) << i;
    ASSERT_EQ(state.P.llt().info(), Eigen::Success) << i;
    ASSERT_TRUE(state.x.allFinite()) << i;
  }
}

} // namespace
} // namespace patina
