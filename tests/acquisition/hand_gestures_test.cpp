// Hands that sway, turn, tap and stop. The truth is their closed form; the filter has no part in
// it.
#include "acquisition/simulation/hand_gestures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "acquisition/files/scan_tables.h"
#include "acquisition/filtering/filtered_scan.h"
#include "acquisition/simulation/simulated_streams.h"
#include "support/shared_data.h"

namespace patina {
namespace {

struct Recording {
  SimulatedHand hand;
  ProbeModel probe;
  std::vector<CameraPose> poses;
  std::vector<bool> wrong; // outliers among the poses
  std::vector<ProbeSample> samples;
  std::vector<RateSample> rates;
  std::vector<Gap> gaps;
};

Recording recordingOf(HandGesture kind, std::uint32_t seed, bool bad) {
  Recording made;
  made.hand = gesture(kind, seed);
  SimulatedCamera camera;
  camera.sigma_angle = 3e-3;
  made.poses = simulateCamera(made.hand, made.probe, camera, seed);
  made.samples = simulateProbe(made.hand, made.probe, {}, seed + 100);
  made.rates = simulateRates(made.hand, made.probe, {}, seed + 200);
  made.wrong.assign(made.poses.size(), false);
  if (!bad) return made;
  for (int i = 0; i < 6; ++i) {
    const double from = 10 * (i + 0.7) / 6.5;
    made.gaps.push_back({from, from + 0.5});
  }
  std::erase_if(made.poses, [&](const CameraPose& pose) {
    return std::any_of(made.gaps.begin(), made.gaps.end(),
                       [&](const Gap& gap) { return pose.t >= gap.from && pose.t < gap.to; });
  });
  std::mt19937 random(seed + 300);
  std::normal_distribution<double> off(0, 32e-3);
  made.wrong.assign(made.poses.size(), false);
  for (std::size_t i = 0; i < made.poses.size(); ++i) {
    made.wrong[i] = random() % 100 < 3;
    if (made.wrong[i]) made.poses[i].position += Vec3(off(random), off(random), off(random));
  }
  return made;
}

struct JudgedPath {
  double rms = 0, outside = 0, nees = 0; // [m], [m]
  double beyond = 0;   // share of the samples in gaps whose error is above three deviations
  double rejected = 0; // share of the good poses
};

JudgedPath judged(const Recording& made, PathModel model, bool gyroscope) {
  ScanFilter filter;
  filter.model = model;
  filter.touching_only = false;
  Progress progress;
  const FilteredScan scan = filterScan(made.poses, made.samples, made.probe, filter, progress,
                                       gyroscope ? made.rates : std::vector<RateSample>());
  JudgedPath j;
  double count = 0, outside = 0, inside = 0;
  for (const PathSample& sample : scan.path) {
    const double error = (sample.position - handAt(made.hand, sample.t).tip).norm();
    const bool in_gap = std::any_of(made.gaps.begin(), made.gaps.end(), [&](const Gap& gap) {
      return sample.t > gap.from - 0.034 && sample.t < gap.to + 0.034;
    });
    j.rms += error * error;
    j.nees += error * error / (3 * sample.sigma * sample.sigma);
    count += 1;
    (in_gap ? inside : outside) += 1;
    if (in_gap)
      j.beyond += error > 3 * std::sqrt(3.) * sample.sigma;
    else
      j.outside += error * error;
  }
  j.rms = std::sqrt(j.rms / count);
  j.outside = std::sqrt(j.outside / outside);
  j.nees /= count;
  if (inside > 0) j.beyond /= inside;
  double good = 0;
  for (std::size_t i = 0; i < made.poses.size(); ++i) {
    if (made.wrong[i]) continue;
    good += 1;
    j.rejected += scan.track.verdicts[i] != PoseVerdict::used;
  }
  j.rejected /= good;
  return j;
}

TEST(HandGestures, AreSmoothAndAsQuickAsTheyState) {
  for (const HandGesture kind : kHandGestures) {
    const SimulatedHand hand = gesture(kind, 1);
    double fastest = 0, hardest = 0, turned = 0;
    constexpr double kStep = 1e-3;
    for (double t = -0.01; t < 10; t += kStep) {
      const HandState a = handAt(hand, t - kStep), b = handAt(hand, t), c = handAt(hand, t + kStep);
      fastest = std::max(fastest, (c.tip - a.tip).norm() / (2 * kStep));
      hardest = std::max(hardest, (a.tip - 2 * b.tip + c.tip).norm() / (kStep * kStep));
      turned = std::max(turned, a.orientation.angularDistance(c.orientation) / (2 * kStep));
    }
    std::printf("%s: %.2f m/s, %.0f m/s^2, %.1f rad/s\n", nameOf(kind), fastest, hardest, turned);
    EXPECT_LT(fastest, 3) << nameOf(kind);
    EXPECT_LT(hardest, 120) << nameOf(kind);
    EXPECT_LT(turned, 15) << nameOf(kind);
    EXPECT_EQ(turned > 3, kind == HandGesture::turning || kind == HandGesture::fast)
        << nameOf(kind);
    EXPECT_EQ(hardest > 15, kind == HandGesture::tapping || kind == HandGesture::stopping)
        << nameOf(kind);
  }
}

TEST(FusedPath, FollowsEveryHandAtLeastAsWellAsTheSimplestModel) {
  for (const HandGesture kind : kHandGestures) {
    const Recording made = recordingOf(kind, 1, false);
    const JudgedPath velocity = judged(made, PathModel::velocity, false),
                 fused = judged(made, PathModel::fused, false),
                 turning = judged(made, PathModel::fused, true);
    std::printf("%-8s velocity %.3f mm, accelerometers %.3f (NEES %.2f), gyroscope %.3f (%.2f)\n",
                nameOf(kind), 1e3 * velocity.rms, 1e3 * fused.rms, fused.nees, 1e3 * turning.rms,
                turning.nees);
    EXPECT_LE(fused.rms, 0.6e-3) << nameOf(kind);
    EXPECT_LE(fused.rms, 1.05 * velocity.rms) << nameOf(kind);
    EXPECT_LE(turning.rms, 0.5e-3) << nameOf(kind);
    for (const JudgedPath& each : {fused, turning}) {
      EXPECT_LE(each.nees, 3) << nameOf(kind);
      EXPECT_LE(each.rejected, 0.01) << nameOf(kind);
    }
  }
}

TEST(FusedPath, StatesItsErrorInGapsBetweenOutliers) {
  for (const HandGesture kind : kHandGestures) {
    const Recording made = recordingOf(kind, 1, true);
    const JudgedPath velocity = judged(made, PathModel::velocity, false),
                 fused = judged(made, PathModel::fused, false),
                 turning = judged(made, PathModel::fused, true);
    std::printf("%-8s velocity %.3f mm, accelerometers %.3f outside the gaps, %.1f %% beyond 3 "
                "sigma inside; gyroscope %.3f over all\n",
                nameOf(kind), 1e3 * velocity.rms, 1e3 * fused.outside, 100 * fused.beyond,
                1e3 * turning.rms);
    EXPECT_LE(fused.outside, 1.5e-3) << nameOf(kind);
    EXPECT_LE(fused.beyond, 0.01) << nameOf(kind);
    EXPECT_LE(fused.rms, 1.05 * velocity.rms) << nameOf(kind);
    EXPECT_LE(turning.rms, 0.8e-3) << nameOf(kind);
    for (const JudgedPath& each : {fused, turning}) {
      EXPECT_LE(each.nees, 3) << nameOf(kind);
      EXPECT_LE(each.rejected, 0.01) << nameOf(kind);
    }
  }
}

// A hand-moved sensor that taps (BROAD: Laidig, Caruso, Cereatti & Seel 2021). Its twin on
// simulated hands is above.
TEST(FusedPath, FollowsARecordedHandThatTaps) {
  const std::filesystem::path folder = test::sharedData("scan/hand_tapping");
  PATINA_SKIP_WITHOUT(folder);
  const Rig rig = readRig(folder / "rig.json");
  const std::vector<CameraPose> poses = readPoses(folder / "poses.tum").values;
  const std::vector<ProbeSample> samples = readProbeStream(folder / "probe.csv").values;
  const std::vector<PathSample> truth = readPath(folder / "truth.csv");
  const auto errorOf = [&](PathModel model) {
    ScanFilter filter;
    filter.model = model;
    filter.touching_only = false;
    filter.gravity = rig.gravity;
    Progress progress;
    const FilteredScan scan = filterScan(poses, samples, rig.probe, filter, progress);
    EXPECT_GE(scan.track.used() + poses.size() / 100, poses.size());
    double squares = 0, count = 0;
    for (const PathSample& known : truth) {
      const auto after =
          std::lower_bound(scan.path.begin(), scan.path.end(), known.t,
                           [](const PathSample& sample, double t) { return sample.t < t; });
      if (after == scan.path.begin() || after == scan.path.end()) continue;
      const PathSample& before = *(after - 1);
      const double share = (known.t - before.t) / (after->t - before.t);
      squares += (before.position + share * (after->position - before.position) - known.position)
                     .squaredNorm();
      count += 1;
    }
    return std::sqrt(squares / count);
  };
  const double velocity = errorOf(PathModel::velocity), fused = errorOf(PathModel::fused);
  std::printf("velocity %.3f mm, fused %.3f mm\n", 1e3 * velocity, 1e3 * fused);
  EXPECT_LE(fused, 0.6e-3);
  EXPECT_LE(fused, 1.05 * velocity);
}

} // namespace
} // namespace patina
