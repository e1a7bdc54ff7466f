#include "acquisition/filtering/filtered_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "acquisition/profile/scan_heights.h"
#include "acquisition/simulation/mesh_strokes.h"
#include "acquisition/simulation/path_error.h"
#include "acquisition/simulation/simulated_streams.h"
#include "acquisition/simulation/simulated_surface.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

struct Scan {
  SimulatedHand hand;
  ProbeModel probe;
  std::vector<CameraPose> poses;
  std::vector<ProbeSample> samples;
  std::vector<PathSample> truth;
};

Scan scanOf(std::uint32_t seed, const SimulatedProbe& stream = {}) {
  Scan scan;
  scan.hand = strokes(seed);
  scan.hand.relief = roughSurface(seed, 25e-6);
  scan.poses = simulateCamera(scan.hand, scan.probe, {}, seed);
  scan.samples = simulateProbe(scan.hand, scan.probe, stream, seed + 100);
  std::vector<double> times;
  for (double i = 0; i < scan.hand.seconds() * 500; ++i) times.push_back(i / 500);
  scan.truth = truthAt(scan.hand, Pose::Identity(), times);
  return scan;
}

FilteredScan filtered(const Scan& scan, const ScanFilter& filter = {}) {
  Progress progress;
  return filterScan(scan.poses, scan.samples, scan.probe, filter, progress);
}

TEST(FilteredScan, KeepsTheSamplesInContact) {
  const Scan scan = scanOf(1);
  const FilteredScan kept = filtered(scan);
  ScanFilter all;
  all.touching_only = false;
  EXPECT_EQ(filtered(scan, all).path.size(), scan.samples.size());
  std::size_t wrong = 0, touching = 0;
  for (const PathSample& sample : scan.truth) touching += sample.force > 0.1;
  for (const PathSample& sample : kept.path) wrong += handAt(scan.hand, sample.t).force < 0.02;
  EXPECT_EQ(wrong, 0u);
  EXPECT_NEAR(static_cast<double>(kept.path.size()), static_cast<double>(touching),
              0.03 * static_cast<double>(touching));
  EXPECT_GT(kept.largest_force, 0.6);
}

// No filter averages out what neighbouring poses share.
TEST(FilteredScan, CoversErrorsThatPosesOfADoubtedRigShare) {
  Scan scan = scanOf(1);
  const double usual = filtered(scan).path[100].sigma;
  for (CameraPose& pose : scan.poses) {
    pose.rig_doubted = true;
    pose.sigma_position = 2e-3;
  }
  const FilteredScan covered = filtered(scan);
  EXPECT_LT(usual, 1e-3);
  const double arm = 5e-3 * scan.probe.tip.norm(); // about 5 mrad at the tip
  for (const PathSample& sample : covered.path) {
    EXPECT_GE(sample.sigma, 2e-3);
    EXPECT_LT(sample.sigma, 2e-3 + arm);
  }
}

// A flat box, 80 mm by 60.
TriangleMesh plate() {
  TriangleMesh mesh;
  mesh.positions = {Vec3(-0.04, -0.03, 0), Vec3(0.04, -0.03, 0), Vec3(0.04, 0.03, 0),
                    Vec3(-0.04, 0.03, 0)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// A single process noise for the whole scan would reject fast lift-offs as outliers.
TEST(FilteredScan, FollowsACalmHandThatLiftsOffFast) {
  for (const double speed : {0.005, 0.01, 0.02, 0.05})
    for (const std::uint32_t seed : {1, 2, 3}) {
      Scan scan;
      scan.hand = scanPathsOver(plate(), seed, 20, speed);
      scan.hand.relief = roughSurface(seed, 25e-6);
      scan.poses = simulateCamera(scan.hand, scan.probe, {}, seed);
      scan.samples = simulateProbe(scan.hand, scan.probe, {}, seed + 100);
      ScanFilter filter;
      filter.touching_only = false;
      const FilteredScan found = filtered(scan, filter);
      double squares = 0, nees = 0, most = 0;
      for (const PathSample& sample : found.path) {
        const double error = (sample.position - handAt(scan.hand, sample.t).tip).norm();
        squares += error * error;
        nees += error * error / (3 * sample.sigma * sample.sigma);
        most = std::max(most, error);
      }
      const double n = static_cast<double>(found.path.size());
      const std::size_t rejected = scan.poses.size() - found.track.used();
      std::printf("%.0f mm/s, seed %u: %zu poses rejected, %.2f mm, at most %.2f, NEES %.2f\n",
                  1e3 * speed, seed, rejected, 1e3 * std::sqrt(squares / n), 1e3 * most, nees / n);
      EXPECT_LE(rejected, 6u);
      EXPECT_LT(std::sqrt(squares / n), 0.6e-3); // .45 at most
      EXPECT_LT(nees / n, 5);                    // 3.98: errors of slow readings are correlated
      EXPECT_TRUE(found.warnings.empty());
    }
}

TEST(FilteredScan, EachModelIsBetterThanTheOneBefore) {
  const Scan scan = scanOf(2);
  double last = INFINITY;
  for (const PathModel model : {PathModel::velocity, PathModel::acceleration, PathModel::fused}) {
    ScanFilter filter;
    filter.model = model;
    const PathError error = errorOf(filtered(scan, filter).path, scan.truth);
    EXPECT_LT(error.rms, last);
    EXPECT_NEAR(error.nees, 1, 0.5);
    last = error.rms;
  }
}

TEST(FilteredScan, PathIsAtThePosesWithoutAProbe) {
  Scan scan = scanOf(3);
  scan.samples.clear();
  ScanFilter filter;
  filter.model = PathModel::acceleration;
  const FilteredScan found = filtered(scan, filter);
  EXPECT_EQ(found.path.size(), found.track.used());
  EXPECT_LT(errorOf(found.path, scan.truth).rms, 0.6e-3);
}

TEST(FilteredScan, MarksItsGapsAndEndsWithThePoses) {
  Scan scan = scanOf(4);
  std::erase_if(scan.poses, [](const CameraPose& pose) {
    return pose.t < 2 || (pose.t > 5 && pose.t < 5.4) || pose.t > 15;
  });
  std::erase_if(scan.samples, [](const ProbeSample& s) { return s.t > 8 && s.t < 8.3; });
  ScanFilter filter;
  filter.touching_only = false;
  const FilteredScan found = filtered(scan, filter);
  EXPECT_NEAR(found.path.front().t, 1.9, 0.05);
  EXPECT_NEAR(found.path.back().t, 15.1, 0.05);
  ASSERT_EQ(found.without_pose.size(), 1u);
  EXPECT_NEAR(found.without_pose[0].from, 5, 0.04);
  EXPECT_NEAR(found.without_pose[0].to, 5.4, 0.04);
  ASSERT_EQ(found.without_sample.size(), 1u);
  EXPECT_NEAR(found.without_sample[0].to, 8.3, 0.01);
  for (const PathSample& sample : found.path)
    if (sample.t > 5.11 && sample.t < 5.29) {
      EXPECT_TRUE(sample.gap) << sample.t;
    }
}

TEST(FilteredScan, LosesOnlyTheSamplesOfAClockJump) {
  for (const double jump : {1e3, 1e9}) {
    Scan scan = scanOf(4);
    for (ProbeSample& sample : scan.samples) sample.t += sample.t > 8 ? jump : 0;
    const FilteredScan found = filtered(scan);
    ASSERT_FALSE(found.path.empty());
    const ScanHeights heights = scanHeights(found, scan.poses, scan.probe, ScanFilter().gravity);
    EXPECT_LE(heights.heights.back().t, 8);
    EXPECT_LE(found.path.back().t, 8);
    EXPECT_GT(found.path.back().t, 6) << jump;
  }
}

TEST(FilteredScan, RefusesStreamsWithoutATimeInCommon) {
  Scan scan = scanOf(5);
  for (CameraPose& pose : scan.poses) pose.t += 1000;
  EXPECT_THROW(filtered(scan), Error);
}

TEST(FilteredScan, IsCancelled) {
  const Scan scan = scanOf(5);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(filterScan(scan.poses, scan.samples, scan.probe, {}, progress), Cancelled);
}

// --- Two clocks.

std::optional<ProbeClock> clockOf(const Scan& scan) {
  Progress progress;
  const FusedOptions options;
  return fitClock(firstPass(scan.poses, scan.probe, options), scan.poses, scan.samples, scan.probe,
                  options, progress)
      .clock;
}

TEST(ProbeClock, IsFoundToAMillisecond) {
  for (const auto& [offset, skew] : {std::pair(0.12, 1e-4), {-0.4, -5e-4}, {5e-3, 0.}}) {
    SimulatedProbe stream;
    stream.clock_offset = offset;
    stream.clock_skew = skew;
    const Scan scan = scanOf(6, stream);
    const auto clock = clockOf(scan);
    ASSERT_TRUE(clock);
    EXPECT_TRUE(clock->is_significant);
    EXPECT_NEAR(clock->offset, offset, 2e-3);
    EXPECT_NEAR(clock->skew, skew, 3e-4);
    EXPECT_NEAR(clock->onCamera(10 * (1 + skew) + offset), 10, 2e-3);
    EXPECT_LT(std::abs(clock->offset - offset), 4 * clock->offset_deviation);
  }
}

TEST(ProbeClock, IsFoundInAFewSecondsToo) {
  for (const std::uint32_t seed : {1, 2, 3}) {
    Scan scan;
    scan.hand = strokes(seed, 3);
    SimulatedProbe stream;
    stream.clock_offset = 0.1;
    scan.poses = simulateCamera(scan.hand, scan.probe, {}, seed);
    scan.samples = simulateProbe(scan.hand, scan.probe, stream, seed + 100);
    const auto clock = clockOf(scan);
    ASSERT_TRUE(clock);
    std::printf("%.1f s: %.2f +- %.2f ms\n", scan.hand.seconds(), 1e3 * clock->offset,
                1e3 * clock->offset_deviation);
    EXPECT_TRUE(clock->is_significant);
    EXPECT_NEAR(clock->onCamera(scan.hand.seconds() / 2 + 0.1), scan.hand.seconds() / 2, 5e-3);
  }
}

TEST(ProbeClock, IsUnchangedIfOffsetIsInsignificant) {
  for (const std::uint32_t seed : {1, 2, 3}) {
    const FilteredScan found = filtered(scanOf(seed));
    ASSERT_TRUE(found.clock);
    EXPECT_FALSE(found.clock->is_significant) << found.clock->offset;
  }
}

// The errors of the poses are correlated in time, like those of markers, and one stroke decides the
// result. If errors were taken to be independent, 17, 20, 26 and 7 of these 40 clocks would be set
// to a wrong value.
TEST(ProbeClock, IsUnchangedUnderCorrelatedErrors) {
  struct Course {
    double before, stroke; // [s]
    double tremor;         // factor of the usual tremor
  };
  for (const auto& [before, stroke, tremor] :
       {Course{4, 1, 1}, {8, 0.4, 0.1}, {8, 1, 0.1}, {2, 0.4, 1}}) {
    int differ = 0;
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      Scan scan;
      scan.hand.seed = seed;
      scan.hand.tremor *= tremor;
      scan.hand.tremor_tilt *= tremor;
      scan.hand.moves = {{Vec2(0, 0), before, 0.3, 0, 1},
                         {Vec2(0.04, 0), stroke, 0, 1, 1},
                         {Vec2(0.04, 0), before, 0.3, 0, 1}};
      scan.poses = simulateCamera(scan.hand, scan.probe, {}, seed);
      scan.samples = simulateProbe(scan.hand, scan.probe, {}, seed + 100);
      std::mt19937 random(seed);
      std::normal_distribution<double> normal;
      Vec3 turn = Vec3::Zero();
      constexpr double kKept = 0.9, kDeviation = 8e-3; // from pose to pose; [rad]
      for (CameraPose& pose : scan.poses) {
        turn = kKept * turn + std::sqrt(1 - kKept * kKept) * kDeviation *
                                  Vec3(normal(random), normal(random), normal(random));
        pose.orientation =
            pose.orientation *
            Eigen::Quaterniond(1, turn.x() / 2, turn.y() / 2, turn.z() / 2).normalized();
      }
      const auto clock = clockOf(scan);
      differ += clock && clock->is_significant;
    }
    std::printf("%g s, a stroke of %g s: %d\n", before, stroke, differ);
    EXPECT_EQ(differ, 0) << before << ' ' << stroke;
  }
}

TEST(ProbeClock, IsNotGuessedFromAProbeAtRest) {
  Scan scan;
  scan.hand.tilt = scan.hand.tremor = scan.hand.tremor_tilt = 0;
  scan.hand.moves = {{Vec2(0, 0), 10, 0, 0, 1}};
  scan.poses = simulateCamera(scan.hand, scan.probe, {}, 1);
  scan.samples = simulateProbe(scan.hand, scan.probe, {}, 2);
  const auto clock = clockOf(scan);
  EXPECT_TRUE(!clock || !clock->is_significant);
}

TEST(ProbeClock, CorrectionCostsNoAccuracy) {
  SimulatedProbe stream;
  stream.clock_offset = 0.08;
  stream.clock_skew = 2e-4;
  const Scan agreeing = scanOf(7), apart = scanOf(7, stream);
  const double with_one = errorOf(filtered(agreeing).path, agreeing.truth).rms;
  EXPECT_LT(errorOf(filtered(apart).path, apart.truth).rms, 1.05 * with_one);
}

// --- The simulation itself.

TEST(MeshStrokes, TouchTheMeshWhereTheyPress) {
  const TriangleMesh mesh = icosphere(0.05, 12);
  const SimulatedHand hand = scanPathsOver(mesh, 3, 20, 0.05);
  std::vector<double> times;
  for (double t = 0; t < hand.seconds(); t += 0.01) times.push_back(t);
  double touching = 0, last_height = 1;
  for (const PathSample& sample : truthAt(hand, Pose::Identity(), times)) {
    EXPECT_LT(std::abs(sample.position.z() - last_height) / 0.01, last_height < 1 ? 0.6 : 1e9)
        << sample.t;
    last_height = sample.position.z();
    if (!sample.touching) continue;
    touching += 1;
    const double radius = sample.position.norm() + sample.force * hand.compliance;
    EXPECT_NEAR(radius, 0.05, 0.1e-3) << sample.t; // facets; it yields along the normal
    EXPECT_GT(sample.position.z() / 0.05, 0.6) << "too steep";
  }
  EXPECT_GT(touching, 0.4 * static_cast<double>(times.size()));
}

TEST(MeshStrokes, AreRejectedIfNothingCanBeScanned) {
  TriangleMesh wall;
  wall.positions = {Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0, 1e-4, 0.1)};
  wall.triangles = {{0, 1, 2}};
  EXPECT_THROW(scanPathsOver(wall, 1, 20, 0.05), Error);
}

TEST(SimulatedStreams, AreSeenFromTheCamera) {
  const SimulatedHand hand = strokes(8, 5);
  const ProbeModel probe;
  SimulatedCamera camera;
  camera.sigma_position = camera.sigma_angle = 0;
  camera.camera_from_world = Pose(Eigen::AngleAxisd(2, Vec3(1, 2, 3).normalized()));
  camera.camera_from_world.translation() = Vec3(0.1, 0.2, 0.4);
  for (const CameraPose& pose : simulateCamera(hand, probe, camera, 1)) {
    const PathSample truth = truthAt(hand, camera.camera_from_world, {pose.t}).at(0);
    EXPECT_LT((pose.position + pose.orientation * probe.tip - truth.position).norm(), 1e-12);
    EXPECT_LT(pose.orientation.angularDistance(truth.orientation), 1e-7);
  }
}

TEST(PathError, IsMeasuredAgainstSegmentsBetweenSamples) {
  std::vector<PathSample> truth(2), path(3);
  truth[1].t = 1;
  truth[1].position = Vec3(1, 0, 0);
  path[0].t = 0.25;
  path[0].position = Vec3(0.25, 0.003, 0.004);
  path[0].sigma = 0.005;
  path[1].t = -1; // before and after it
  path[2].t = 2;
  const PathError error = errorOf(path, truth);
  EXPECT_EQ(error.samples, 1u);
  EXPECT_NEAR(error.rms, 0.005, 1e-15);
  EXPECT_NEAR(error.most, 0.005, 1e-15);
  EXPECT_NEAR(error.nees, 1. / 3, 1e-12);
}

} // namespace
} // namespace patina
