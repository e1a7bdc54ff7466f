#include "acquisition/filtering/fused_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <Eigen/Dense>

#include "acquisition/simulation/simulated_streams.h"
#include "acquisition/simulation/simulated_surface.h"
#include "core/decompose.h"
#include "support/longer.h"

namespace patina {
namespace {

using State = ErrorState;

// --- The bookkeeping, against dense matrices.

Eigen::MatrixXd denseStep(double dt) {
  Eigen::MatrixXd F = Eigen::MatrixXd::Identity(State::kSize, State::kSize);
  for (const int at : {State::kTip, State::kAngle})
    for (int i = 0; i < 3; ++i) {
      F(at + i, at + 3 + i) = F(at + 3 + i, at + 6 + i) = dt;
      F(at + i, at + 6 + i) = dt * dt / 2;
    }
  return F;
}

MeasurementRow anyRow(std::mt19937& random) {
  std::normal_distribution<double> normal;
  MeasurementRow row;
  for (const int at : {State::kTip, State::kAcceleration, State::kAngle})
    row.add(at, Vec3(normal(random), normal(random), normal(random)));
  row.add(State::kBias + static_cast<int>(random() % 4), 1);
  return row;
}

Eigen::VectorXd dense(const MeasurementRow& row) {
  Eigen::VectorXd h = Eigen::VectorXd::Zero(State::kSize);
  for (std::size_t i = 0; i < static_cast<std::size_t>(row.count); ++i)
    h[row.index[i]] += row.value[i];
  return h;
}

// The oracle: the smoothed first state as one least-squares problem.
TEST(ErrorState, SmoothsAsBatchLeastSquaresDoes) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const double dt = 0.3, variance = 0.5;
  State state;
  state.P.diagonal().setConstant(2);
  const State::Square first_P = state.P;
  const Eigen::Matrix3d jerk = Vec3(1, 2, 3).asDiagonal(), angular = Vec3(2, 1, 1).asDiagonal();
  // The unknowns are all states. The biases are constant, because their noise is negligible.
  constexpr int kSteps = 4, n = State::kSize;
  Eigen::MatrixXd normal_matrix = Eigen::MatrixXd::Zero(kSteps * n, kSteps * n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kSteps * n);
  normal_matrix.topLeftCorner(n, n) = SymmetricSolver(first_P).inverse();
  std::vector<State> filtered;
  std::vector<std::vector<ProcessedRow>> used(kSteps);
  for (int k = 0; k < kSteps; ++k) {
    if (k > 0) {
      State noise; // Q alone
      predict(noise, dt, jerk, angular);
      Eigen::MatrixXd Q = noise.P;
      Q.diagonal().tail<State::kSize - State::kBias>().setConstant(1e-10);
      Eigen::MatrixXd link(n, 2 * n);
      link << -denseStep(dt), Eigen::MatrixXd::Identity(n, n);
      normal_matrix.block((k - 1) * n, (k - 1) * n, 2 * n, 2 * n) +=
          product(link.transpose(), SymmetricSolver(Q).solveColumns(link));
      predict(state, dt, jerk, angular);
    }
    for (int i = 0; i < 5; ++i) {
      const MeasurementRow row = anyRow(random);
      const double measured = normal(random);
      used[static_cast<std::size_t>(k)].push_back(
          update(state, row, measured - row.dot(state.x), variance));
      const Eigen::VectorXd h = dense(row);
      normal_matrix.block(k * n, k * n, n, n) += h * h.transpose() / variance;
      right.segment(k * n, n) += h * measured / variance;
    }
    filtered.push_back(state);
  }
  const Eigen::MatrixXd P = SymmetricSolver(normal_matrix).inverse();
  const Eigen::VectorXd x = P * right;
  BrysonFrazierState adjoint;
  for (int k = kSteps - 1; k >= 0; --k) {
    const State& s = filtered[static_cast<std::size_t>(k)];
    const State::Vector smooth = s.x - s.P * adjoint.l;
    const State::Square covariance = s.P - s.P * adjoint.L * s.P;
    EXPECT_TRUE(smooth.isApprox(x.segment(k * n, n), 1e-5)) << k;
    EXPECT_TRUE(covariance.isApprox(P.block(k * n, k * n, n, n), 1e-5)) << k;
    auto& rows = used[static_cast<std::size_t>(k)];
    for (std::size_t i = rows.size(); i-- > 0;) adjoint.smoothMeasurement(rows[i]);
    adjoint.smoothStep(dt);
  }
}

TEST(ErrorState, StaysSymmetricAndPositiveForFiveMinutesOfOutliers) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  State state;
  const double wide[] = {0.02, 0.3, 5, 0.1, 2, 20};
  for (int i = 0; i < 6; ++i) state.P.diagonal().segment<3>(3 * i).setConstant(wide[i] * wide[i]);
  state.P.diagonal().tail<State::kSize - State::kBias>().setConstant(0.09);
  const ProbeModel probe;
  const Eigen::Matrix3d jerk = Vec3::Constant(1).asDiagonal(), angular = 4 * jerk;
  for (int k = 0; k < 150000; ++k) {
    predict(state, 0.002, jerk, angular);
    for (std::size_t i = 0; i < 4; ++i) {
      MeasurementRow row;
      row.add(State::kAcceleration, probe.axes[i].direction);
      row.add(State::kAngle, Vec3(probe.axes[i].direction.cross(Vec3(0, 0, 9.8))));
      row.add(State::kRateOfRate,
              (probe.axes[i].position - probe.tip).cross(probe.axes[i].direction));
      row.add(State::kBias + static_cast<int>(i), 1);
      update(state, row, 0.05 * normal(random) + (k % 33 == 0 ? 100 : 0), 0.0022);
    }
    if (k % 17 == 0)
      for (int i = 0; i < 3; ++i) {
        MeasurementRow angle, place;
        angle.add(State::kAngle + i, 1);
        update(state, angle, 0.005 * normal(random), 2.5e-5);
        place.add(State::kTip + i, 1);
        update(state, place, (k % 510 == 0 ? 1 : 2e-4) * normal(random), 4e-8);
      }
    if (k % 500 != 499) continue;
    ASSERT_TRUE(state.x.allFinite() && state.P.allFinite()) << k;
    ASSERT_LT((state.P - state.P.transpose()).cwiseAbs().maxCoeff(),
              1e-12 * state.P.diagonal().maxCoeff())
        << k;
    // Errors are scaled by their deviations; otherwise metres beside radians would hide a loss.
    const State::Vector scale = state.P.diagonal().cwiseSqrt().cwiseInverse();
    const State::Square even = scale.asDiagonal() * state.P * scale.asDiagonal();
    ASSERT_GT(SymmetricEigen(even).values[0], 0) << k;
  }
}

// --- Scans with known truth.

struct FusedScan {
  SimulatedHand hand;
  ProbeModel probe;
  std::vector<CameraPose> poses;
  std::vector<ProbeSample> samples;
};

FusedScan scanOf(std::uint32_t seed, bool faults) {
  FusedScan scan;
  scan.hand = strokes(seed);
  scan.hand.relief = roughSurface(seed, 25e-6);
  SimulatedCamera camera;
  if (faults) {
    camera.outliers = 0.03;
    for (double begin = 3; begin < 20; begin += 4.5) camera.gaps.push_back({begin, begin + 0.3});
  }
  scan.poses = simulateCamera(scan.hand, scan.probe, camera, seed);
  scan.samples = simulateProbe(scan.hand, scan.probe, {}, seed + 100);
  return scan;
}

double rawError(const FusedScan& scan) {
  double squares = 0;
  for (const CameraPose& pose : scan.poses)
    squares += (pose.position + pose.orientation * scan.probe.tip - handAt(scan.hand, pose.t).tip)
                   .squaredNorm();
  return std::sqrt(squares / static_cast<double>(scan.poses.size()));
}

struct Judged {
  double tip = 0, nees = 0, angle = 0;
  std::vector<double> height_errors, heights; // heights of the tip and their errors [m]
};

Judged judged(const FusedScan& scan, const std::vector<PathSample>& path) {
  Judged j;
  const auto n = static_cast<double>(path.size());
  for (const PathSample& sample : path) {
    const HandState truth = handAt(scan.hand, sample.t);
    const Vec3 error = sample.position - truth.tip;
    const double angle = sample.orientation.angularDistance(truth.orientation);
    j.tip += error.squaredNorm() / n;
    j.nees += error.squaredNorm() / (3 * sample.sigma * sample.sigma) / n;
    j.angle += angle * angle / (3 * sample.sigma_angle * sample.sigma_angle) / n;
    j.height_errors.push_back(error.z());
    j.heights.push_back(truth.tip.z());
  }
  j.tip = std::sqrt(j.tip);
  return j;
}

TEST(FusedPath, IsBetterThanTheCameraAloneAndStatesItsError) {
  for (const bool faults : {false, true})
    for (const std::uint32_t seed : {1, 2, 3}) {
      const FusedScan scan = scanOf(seed, faults);
      const FusedPath fused = fusePath(scan.poses, scan.samples, scan.probe);
      ASSERT_EQ(fused.path.size(), scan.samples.size());
      std::vector<double> times;
      for (const ProbeSample& sample : scan.samples) times.push_back(sample.t);
      const double raw = rawError(scan);
      const Judged ours = judged(scan, fused.path),
                   camera = judged(scan, pathAt(fused.track, times));
      std::printf("%s %u: raw %.3f mm, camera %.3f, fused %.3f of it; nees %.2f, angle %.2f\n",
                  faults ? "faults" : "clean ", seed, 1e3 * raw, camera.tip / raw, ours.tip / raw,
                  ours.nees, ours.angle);
      EXPECT_LE(ours.tip / raw, faults ? 0.06 : 0.40);
      EXPECT_LT(ours.tip, 0.8 * camera.tip);
      EXPECT_NEAR(ours.nees, 1, 0.5);
      EXPECT_NEAR(ours.angle, 1, 0.5);
    }
}

TEST(FusedPath, StatedErrorHoldsForFiveMinutesOfOutliers) {
  FusedScan scan;
  scan.hand = strokes(10, 300);
  SimulatedCamera camera;
  camera.outliers = 0.03;
  for (double begin = 3; begin < 300; begin += 4.5) camera.gaps.push_back({begin, begin + 0.3});
  scan.poses = simulateCamera(scan.hand, scan.probe, camera, 10);
  scan.samples = simulateProbe(scan.hand, scan.probe, {}, 110);
  const FusedPath fused = fusePath(scan.poses, scan.samples, scan.probe);
  for (const PathSample& sample : fused.path)
    ASSERT_TRUE(sample.sigma > 1e-5 && sample.sigma < 0.02 && sample.sigma_angle > 1e-5)
        << sample.t << " " << sample.sigma << " " << sample.sigma_angle;
  EXPECT_NEAR(judged(scan, fused.path).nees, 1, 0.5);
  EXPECT_LT(judged(scan, fused.path).tip, 0.06 * rawError(scan));
}

// The recording was paused: both streams continue later and the hand has not moved.
TEST(FusedPath, StatedErrorHoldsAfterAPauseOfAnyLength) {
  for (const double pause : {0.9, 2., 6., 200., 1e4, 1e8}) {
    const FusedScan scan = scanOf(1, false);
    FusedScan paused = scan;
    for (CameraPose& pose : paused.poses) pose.t += pose.t > 8 ? pause : 0;
    for (ProbeSample& sample : paused.samples) sample.t += sample.t > 8 ? pause : 0;
    FusedPath fused = fusePath(paused.poses, paused.samples, paused.probe);
    ASSERT_EQ(fused.path.size(), scan.samples.size());
    for (PathSample& sample : fused.path) sample.t -= sample.t > 8 ? pause : 0;
    const Judged ours = judged(scan, fused.path);
    std::printf("pause of %.0f s: %.3f of the raw error, nees %.2f\n", pause,
                ours.tip / rawError(scan), ours.nees);
    EXPECT_LE(ours.tip / rawError(scan), 0.40) << pause;
    EXPECT_NEAR(ours.nees, 1, 0.5) << pause;
    for (const PathSample& sample : fused.path) ASSERT_GT(sample.sigma, 1e-5) << sample.t;
  }
}

TEST(FusedPath, RecoversAfterMinutesWithoutTheCamera) {
  FusedScan scan;
  scan.hand = strokes(10, 300);
  scan.poses = simulateCamera(scan.hand, scan.probe, {}, 10);
  std::erase_if(scan.poses, [](const CameraPose& pose) { return pose.t > 20 && pose.t < 270; });
  scan.samples = simulateProbe(scan.hand, scan.probe, {}, 110);
  std::vector<PathSample> path = fusePath(scan.poses, scan.samples, scan.probe).path;
  for (const PathSample& sample : path) ASSERT_TRUE(std::isfinite(sample.sigma)) << sample.t;
  std::erase_if(path, [](const PathSample& sample) { return sample.t > 19 && sample.t < 271; });
  EXPECT_LE(judged(scan, path).tip, 0.4 * rawError(scan));
  EXPECT_NEAR(judged(scan, path).nees, 1, 0.5);
}

// Rounding must not turn a long gap into a position that seems exact.
TEST(FusedPath, StatedErrorHoldsInAGapOfSeconds) {
  for (const double gap : {0.5, 1., 1.4, 2., 4., 4.9})
    for (std::uint32_t seed = 1; seed <= (test::isLong() ? 6U : 2U); ++seed) {
      FusedScan scan = scanOf(seed, false);
      std::erase_if(scan.poses,
                    [&](const CameraPose& pose) { return pose.t > 6 && pose.t < 6 + gap; });
      const std::vector<PathSample> path = fusePath(scan.poses, scan.samples, scan.probe).path;
      double least = INFINITY, most = 0;
      for (const PathSample& sample : path) {
        least = std::min(least, sample.sigma);
        const double error = (sample.position - handAt(scan.hand, sample.t).tip).norm();
        most = std::max(most, error / (std::sqrt(3.) * sample.sigma));
      }
      std::printf("gap of %.1f s, seed %u: sigma %.1e at least, %.1f deviations at most\n", gap,
                  seed, least, most);
      EXPECT_GT(least, 1e-5);
      EXPECT_LT(most, 10);
    }
}

TEST(FusedPath, InnovationsRevealAWrongRig) {
  for (const std::uint32_t seed : {1, 2, 3}) {
    const FusedScan scan = scanOf(seed, false);
    const auto worst = [](const FusedPath& fused) {
      return std::max(fused.pose_nis,
                      *std::max_element(fused.axis_nis.begin(), fused.axis_nis.end()));
    };
    const double right = worst(fusePath(scan.poses, scan.samples, scan.probe));
    ProbeModel reversed = scan.probe, swapped = scan.probe;
    reversed.axes[0].direction *= -1;
    std::swap(swapped.axes[0].direction, swapped.axes[2].direction);
    std::vector<ProbeSample> in_g = scan.samples;
    for (ProbeSample& sample : in_g)
      for (double& a : sample.acceleration) a /= 9.80665;
    FusedOptions tilted;
    tilted.gravity = Eigen::AngleAxisd(0.1, Vec3::UnitX()) * tilted.gravity;
    const double wrong[] = {worst(fusePath(scan.poses, scan.samples, reversed)),
                            worst(fusePath(scan.poses, scan.samples, swapped)),
                            worst(fusePath(scan.poses, in_g, scan.probe)),
                            worst(fusePath(scan.poses, scan.samples, scan.probe, tilted))};
    std::printf("seed %u: %.2f; reversed %.1f, swapped %.1f, in g %.1f, gravity .1 rad off %.1f\n",
                seed, right, wrong[0], wrong[1], wrong[2], wrong[3]);
    EXPECT_LT(right, 1.5);
    for (const double nis : wrong) EXPECT_GT(nis, 4); // filterScan() warns above this limit
  }
}

TEST(FusedPath, FindsTheBiasesOfTheAccelerometers) {
  const FusedScan scan = scanOf(4, false);
  const FusedPath fused = fusePath(scan.poses, scan.samples, scan.probe);
  const std::array<double, 4> bias = SimulatedProbe().bias;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(fused.bias[i], bias[i], 0.015) << i;
}

TEST(FusedPath, IgnoresInvalidSamples) {
  FusedScan scan = scanOf(5, false);
  const std::size_t all = scan.samples.size();
  scan.samples[100].force = std::nan("");
  scan.samples[200].acceleration[2] = INFINITY;
  scan.samples[300].t = scan.samples[299].t;
  scan.samples[400].t = 0.1;
  const FusedPath fused = fusePath(scan.poses, scan.samples, scan.probe);
  EXPECT_EQ(fused.path.size(), all - 4);
  EXPECT_LT(judged(scan, fused.path).tip, 0.4 * rawError(scan));
}

TEST(FusedPath, MarksSamplesWithoutTheCamera) {
  FusedScan scan = scanOf(6, false);
  std::erase_if(scan.poses, [](const CameraPose& pose) { return pose.t > 5 && pose.t < 7; });
  const FusedPath fused = fusePath(scan.poses, scan.samples, scan.probe);
  const std::array<double, 4> bias = SimulatedProbe().bias;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(fused.bias[i], bias[i], 0.02) << i;
  for (const PathSample& sample : fused.path) {
    if (sample.t > 5.1 && sample.t < 6.9) {
      EXPECT_TRUE(sample.gap) << sample.t;
    }
    if (sample.t > 1 && sample.t < 4.9) {
      EXPECT_FALSE(sample.gap) << sample.t;
    }
    // In the gap sigma comes from a linear model of a nonlinear hand: only its size is right.
    const double deviations = sample.gap ? 8 : 4.5;
    EXPECT_LT((sample.position - handAt(scan.hand, sample.t).tip).norm(),
              deviations * std::sqrt(3.) * sample.sigma)
        << sample.t;
  }
}

TEST(FusedPath, RecoversAfterAJumpOfTheCamera) {
  FusedScan scan = scanOf(7, false);
  const double jump = scan.poses[300].t;
  for (CameraPose& pose : scan.poses)
    if (pose.t >= jump) pose.position.x() += 0.1;
  const FusedPath fused = fusePath(scan.poses, scan.samples, scan.probe);
  EXPECT_EQ(fused.track.restarts, 1u);
  for (const PathSample& sample : fused.path) {
    if (std::abs(sample.t - jump) < 0.2) continue;
    const Vec3 moved = sample.t > jump ? Vec3(0.1, 0, 0) : Vec3(0, 0, 0);
    EXPECT_LT((sample.position - handAt(scan.hand, sample.t).tip - moved).norm(), 3e-3) << sample.t;
  }
}

TEST(FusedPath, TakesPosesAndReadingsWithoutNoise) {
  FusedScan scan = scanOf(9, false);
  scan.probe.acceleration_noise = scan.probe.acceleration_step = 0;
  SimulatedCamera exact;
  exact.sigma_position = exact.sigma_angle = 0;
  scan.poses = simulateCamera(scan.hand, scan.probe, exact, 9);
  for (const bool still : {false, true}) {
    if (still)
      for (CameraPose& pose : scan.poses) pose.position = Vec3::Zero();
    const FusedPath fused = fusePath(scan.poses, scan.samples, scan.probe);
    ASSERT_EQ(fused.path.size(), scan.samples.size());
    for (const PathSample& sample : fused.path)
      ASSERT_TRUE(sample.position.allFinite() && sample.sigma >= 0 && sample.sigma_angle >= 0)
          << sample.t;
    if (!still) {
      EXPECT_LT(judged(scan, fused.path).tip, 0.1e-3);
    }
  }
}

TEST(FusedPath, IsEmptyWithoutPoses) {
  const FusedScan scan = scanOf(8, false);
  EXPECT_TRUE(fusePath({}, scan.samples, scan.probe).path.empty());
  EXPECT_TRUE(fusePath(scan.poses, {}, scan.probe).path.empty());
}

} // namespace
} // namespace patina
