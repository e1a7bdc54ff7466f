#include "acquisition/calibration/probe_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace patina {
namespace {

struct HeldProbe {
  std::vector<CameraPose> poses;
  std::vector<ProbeSample> samples;
};

const std::array<double, 4> kBias{0.06, -0.04, 0.05, -0.07};
const Vec3 kDown = 9.80665 * Vec3(0.1, 0.85, 0.5).normalized();

// The probe rests in each attitude for some seconds and rotates quickly between them.
HeldProbe held(const ProbeModel& model, int attitudes, double lean, std::uint32_t seed,
               int seconds = 2) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1, 1);
  HeldProbe probe;
  for (int i = 0; i < attitudes; ++i) {
    const double a = unit(random), b = unit(random), c = unit(random);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(lean * a, Vec3::UnitX()) *
                                  Eigen::AngleAxisd(lean * b, Vec3::UnitY()) *
                                  Eigen::AngleAxisd(lean * c, Vec3::UnitZ()));
    for (int k = 0; k < 30 * seconds; ++k) {
      CameraPose pose;
      pose.t = seconds * i + k / 30.;
      pose.sigma_angle = 2e-3;
      const double x = normal(random), y = normal(random), z = normal(random);
      const Vec3 error = 2e-3 * Vec3(x, y, z);
      pose.orientation =
          turn * Eigen::Quaterniond(Eigen::AngleAxisd(error.norm(), error.normalized()));
      probe.poses.push_back(pose);
    }
    for (int k = 0; k < 500 * seconds; ++k) {
      ProbeSample sample;
      sample.t = seconds * i + k / 500.;
      sample.force = 0.03;
      for (std::size_t axis = 0; axis < 4; ++axis) {
        const double exact =
            -model.axes[axis].direction.dot(turn.conjugate() * kDown) + kBias[axis];
        const double noisy = exact + model.acceleration_noise * normal(random);
        sample.acceleration[axis] =
            model.acceleration_step * std::round(noisy / model.acceleration_step);
      }
      probe.samples.push_back(sample);
    }
  }
  return probe;
}

TEST(AccelerometerCalibration, FindsGravityAxesAndBiases) {
  ProbeModel known, rough;
  for (AccelerometerAxis& axis : known.axes)
    axis.direction = Eigen::AngleAxisd(0.15, Vec3(1, -2, 0.5).normalized()) * axis.direction;
  known.axes[1].direction = Eigen::AngleAxisd(0.1, Vec3::UnitX()) * known.axes[1].direction;
  for (const int seconds : {1, 2, 10}) {
    double nees = 0;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      const HeldProbe probe = held(known, 25, 1.2, seed, seconds);
      const auto fit = calibrateAccelerometers(probe.poses, probe.samples, rough);
      ASSERT_TRUE(fit);
      EXPECT_EQ(fit->attitudes, 25u);
      EXPECT_LT((fit->gravity - kDown).norm(), 0.03);
      EXPECT_NEAR(fit->force_zero, 0.03, 1e-9);
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_LT((fit->directions[k] - known.axes[k].direction).norm(), 0.01);
        EXPECT_NEAR(fit->bias[k], kBias[k], 0.05);
        EXPECT_NEAR(fit->gain[k], 1, 0.01);
        nees += (fit->directions[k] - known.axes[k].direction).squaredNorm() /
                (2 * fit->deviation[k] * fit->deviation[k]) / 40;
      }
    }
    std::printf("held for %d s: NEES of the axes %.2f\n", seconds, nees);
    EXPECT_NEAR(nees, 1, 0.6) << seconds;
  }
}

TEST(AccelerometerCalibration, ShowsAWrongUnitInTheGain) {
  const ProbeModel model;
  HeldProbe probe = held(model, 25, 1.2, 1);
  for (ProbeSample& sample : probe.samples) sample.acceleration[1] *= 1.1;
  const auto fit = calibrateAccelerometers(probe.poses, probe.samples, model);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->gain[1], 1.1, 0.02);
  EXPECT_NEAR(fit->gain[0], 1, 0.02);
}

TEST(AccelerometerCalibration, ReturnsNothingForSimilarOrMovingAttitudes) {
  const ProbeModel model;
  HeldProbe probe = held(model, 25, 0.02, 1);
  EXPECT_FALSE(calibrateAccelerometers(probe.poses, probe.samples, model)) << "similar attitudes";
  probe = held(model, 2, 1.2, 1);
  EXPECT_FALSE(calibrateAccelerometers({}, probe.samples, model));
  EXPECT_FALSE(calibrateAccelerometers(probe.poses, {}, model));
  EXPECT_FALSE(calibrateAccelerometers(probe.poses, probe.samples, model)) << "too few";
  probe = held(model, 25, 1.2, 1);
  for (ProbeSample& sample : probe.samples) sample.acceleration[2] += 2 * std::sin(60 * sample.t);
  EXPECT_FALSE(calibrateAccelerometers(probe.poses, probe.samples, model)) << "moving";
}

} // namespace
} // namespace patina
