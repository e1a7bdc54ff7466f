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
#include "core/csv.h"
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

// Leaves out the poses of six gaps of half a second and puts 3 % of the others aside.
void spoil(Recording& made, std::uint32_t seed, double begin, double seconds) {
  for (int i = 0; i < 6; ++i) {
    const double from = begin + seconds * (i + 0.7) / 6.5;
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
}

Recording recordingOf(HandGesture kind, std::uint32_t seed, bool bad) {
  Recording made;
  made.hand = gesture(kind, seed);
  SimulatedCamera camera;
  camera.sigma_angle = 3e-3;
  made.poses = simulateCamera(made.hand, made.probe, camera, seed);
  made.samples = simulateProbe(made.hand, made.probe, {}, seed + 100);
  made.rates = simulateRates(made.hand, made.probe, {}, seed + 200);
  made.wrong.assign(made.poses.size(), false);
  if (bad) spoil(made, seed, 0, 10);
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
  std::vector<std::pair<HandGesture, std::uint32_t>> hands = {{HandGesture::turning, 3}};
  for (const HandGesture kind : kHandGestures) hands.emplace_back(kind, 1);
  for (const auto& [kind, seed] : hands) {
    const Recording made = recordingOf(kind, seed, true);
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

TEST(FusedPath, CorrectsScaleAndAxesOfAGyroscope) {
  Eigen::Matrix3d lean;
  lean << 1.01, 0.01, -0.02, 0.015, 0.99, 0, 0, 0.02, 1;
  for (const HandGesture kind : {HandGesture::fast, HandGesture::turning}) {
    Recording made = recordingOf(kind, 1, true);
    const double exact = judged(made, PathModel::fused, true).rms;
    for (RateSample& rate : made.rates) rate.rate = lean * rate.rate;
    const JudgedPath leaning = judged(made, PathModel::fused, true);
    std::printf("%s: gyroscope exact %.3f mm, leaning %.3f (NEES %.2f)\n", nameOf(kind),
                1e3 * exact, 1e3 * leaning.rms, leaning.nees);
    EXPECT_LE(leaning.rms, 1.3 * exact) << nameOf(kind);
    EXPECT_LE(leaning.nees, 3) << nameOf(kind);
  }
}

// An outlier beside a gap or at the end is predicted from one side only, and its good neighbours
// were rejected in its place.
TEST(FusedPath, KeepsGoodPosesBesideAnOutlierAtAGap) {
  for (const HandGesture kind : {HandGesture::tapping, HandGesture::stopping}) {
    Recording made = recordingOf(kind, 3, false);
    for (const double from : {2., 5., 8.}) made.gaps.push_back({from, from + 0.5});
    std::erase_if(made.poses, [&](const CameraPose& pose) {
      return std::any_of(made.gaps.begin(), made.gaps.end(),
                         [&](const Gap& gap) { return pose.t >= gap.from && pose.t < gap.to; });
    });
    made.wrong.assign(made.poses.size(), false);
    const auto spoil = [&](std::size_t i) {
      made.poses[i].position += Vec3(0.02, -0.03, 0.025);
      made.wrong[i] = true;
    };
    std::vector<std::size_t> edges{made.poses.size() - 1};
    for (std::size_t i = 1; i < made.poses.size(); ++i)
      if (made.poses[i].t - made.poses[i - 1].t > 0.4) edges.push_back(i - edges.size() % 2);
    for (const std::size_t edge : edges) spoil(edge);
    for (const bool gyroscope : {false, true}) {
      const JudgedPath path = judged(made, PathModel::fused, gyroscope);
      EXPECT_LE(path.rejected, 0.005) << nameOf(kind) << gyroscope;
      EXPECT_LE(path.outside, 0.5e-3) << nameOf(kind) << gyroscope;
    }
  }
}

// The likeliest noise of the angle was that of the pauses, with each turn an outlier.
TEST(CameraTrack, KeepsThePosesOfAHandThatTurnsAndPauses) {
  for (const std::uint32_t seed : {1, 10}) {
    const Recording made = recordingOf(HandGesture::turning, seed, false);
    const CameraTrack track = firstPass(made.poses, made.probe, {});
    EXPECT_EQ(track.used(), made.poses.size()) << seed;
  }
}

std::vector<ProbeSample> shifted(std::vector<ProbeSample> samples, double offset) {
  for (ProbeSample& sample : samples) sample.t += offset;
  return samples;
}

ClockFit clockOf(const Recording& made, double offset, const Vec3& gravity = kGravity) {
  FusedOptions options;
  options.gravity = gravity;
  Progress progress;
  return fitClock(firstPass(made.poses, made.probe, options), made.poses,
                  shifted(made.samples, offset), made.probe, options, progress);
}

// The offset at which stamps of the middle are corrected; absent if it is neither known nor far
// off.
std::optional<double> correctionOf(const ClockFit& fit, double middle) {
  if (!fit.clock || !(fit.clock->isKnown() || fit.clock->is_significant)) return std::nullopt;
  return fit.clock->is_significant ? middle - fit.clock->onCamera(middle) : 0.;
}

TEST(ProbeClock, IsFoundToTwoMillisecondsOrUnknown) {
  int found = 0, all = 0;
  std::string doubts;
  for (const HandGesture kind : kHandGestures)
    for (const bool bad : {false, true}) {
      const Recording made = recordingOf(kind, 1, bad);
      for (const double offset : {0., 0.02, -0.05, 0.2}) {
        const ClockFit fit = clockOf(made, offset);
        const std::optional<double> correction = correctionOf(fit, 5 + offset);
        EXPECT_EQ(fit.clock && fit.clock->isKnown(), fit.doubt.empty());
        EXPECT_NEAR(correction.value_or(offset), offset, 2e-3) << nameOf(kind) << bad;
        if (bad) continue;
        found += correction.has_value();
        if (!correction) doubts += std::string(nameOf(kind)) + ": " + fit.doubt + "\n";
        ++all;
      }
    }
  EXPECT_GE(found, 0.9 * all) << doubts;
}

// A gyroscope with a low-pass filter lags behind the accelerometers.
TEST(ProbeClock, FindsTheDelayOfAGyroscope) {
  for (const double delay : {0., 4e-3}) {
    Recording made = recordingOf(HandGesture::fast, 1, false);
    for (RateSample& rate : made.rates) rate.t += 0.02 + delay;
    Progress progress;
    const ClockFit fit =
        fitClock(firstPass(made.poses, made.probe, {}), made.poses, shifted(made.samples, 0.02),
                 made.probe, {}, progress, made.rates);
    ASSERT_TRUE(fit.clock);
    EXPECT_NEAR(fit.clock->ofGyroscope(5.02 + delay), 5, 1e-3) << delay;
    EXPECT_EQ(fit.clock->gyroscope_delay == 0, delay == 0);
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
  const auto errorOf = [&](PathModel model, const std::vector<CameraPose>& seen,
                           const std::vector<RateSample>& rates = {}) {
    ScanFilter filter;
    filter.model = model;
    filter.touching_only = false;
    filter.gravity = rig.gravity;
    Progress progress;
    const FilteredScan scan = filterScan(seen, samples, rig.probe, filter, progress, rates);
    if (seen.size() == poses.size()) {
      EXPECT_GE(scan.track.used() + poses.size() / 100, poses.size());
    }
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
  std::vector<RateSample> rates;
  for (const std::vector<double>& row :
       readCsv(folder / "gyro.csv", {"t [s]", "wx [rad/s]", "wy [rad/s]", "wz [rad/s]"}).rows)
    rates.push_back({row[0], Vec3(row[1], row[2], row[3])});
  const double velocity = errorOf(PathModel::velocity, poses),
               fused = errorOf(PathModel::fused, poses),
               turning = errorOf(PathModel::fused, poses, rates);
  EXPECT_LE(turning, 0.5e-3);
  for (const std::uint32_t seed : {1, 2, 5}) {
    Recording bad;
    bad.poses = poses;
    spoil(bad, seed, poses.front().t, poses.back().t - poses.front().t);
    const double bridged = errorOf(PathModel::fused, bad.poses, rates);
    std::printf("gyroscope %.3f mm, with gaps and outliers %.3f\n", 1e3 * turning, 1e3 * bridged);
    EXPECT_LE(bridged, 0.8e-3) << seed;
  }
  std::printf("velocity %.3f mm, fused %.3f mm\n", 1e3 * velocity, 1e3 * fused);
  EXPECT_LE(fused, 0.6e-3);
  EXPECT_LE(fused, 1.05 * velocity);
  Recording made;
  made.probe = rig.probe;
  made.poses = poses;
  made.samples = samples;
  for (const double offset : {0., 0.02, -0.02, 0.05, -0.05, 0.2, -0.2}) {
    const auto correction =
        correctionOf(clockOf(made, offset, rig.gravity), poses[poses.size() / 2].t + offset);
    ASSERT_TRUE(correction) << offset;
    EXPECT_NEAR(*correction, offset, 2e-3);
  }
}

} // namespace
} // namespace patina
