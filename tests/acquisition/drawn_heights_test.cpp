// Textures of scans with known true heights; slow parts must be as accurate as fast ones.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "acquisition/filtering/filtered_scan.h"
#include "acquisition/simulation/mesh_strokes.h"
#include "acquisition/simulation/simulated_streams.h"
#include "acquisition/simulation/simulated_surface.h"
#include "acquisition/texture/fit_texture.h"
#include "acquisition/texture/mesh_heights.h"
#include "core/decompose.h"
#include "core/error.h"
#include "field/surface/models.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

TEST(CourseOf, PassesEachWaveByTheClosedForm) {
  constexpr double kStep = 1e-4, kLength = 0.012;
  constexpr int kCount = 6000;
  for (const double ratio : {0.3, 0.6, 0.8, 1., 1.25, 2., 4.}) { // wavelength over length
    std::vector<double> wave;
    for (int i = 0; i < kCount; ++i)
      wave.push_back(std::cos(2 * std::numbers::pi * (i - kCount / 2) * kStep / (ratio * kLength)));
    const std::vector<double> course =
        wavinessOf(wave, std::vector<double>(kCount, 1.), kStep, kLength);
    EXPECT_NEAR(course[kCount / 2], 1 / (1 + std::pow(ratio, -6)), 0.02) << ratio;
  }
}

TEST(CourseOf, BridgesUnknownHeightsAndHasNoEndEffects) {
  constexpr double kStep = 1e-4;
  std::vector<double> heights, weights;
  for (int i = 0; i < 600; ++i) {
    const double x = kStep * i;
    const bool known = i >= 30 && (i < 300 || i >= 340) && i < 580;
    heights.push_back(known ? 1e-3 + 0.02 * x - 3 * x * x : 0.1 * (i % 7));
    weights.push_back(known);
  }
  const std::vector<double> course = wavinessOf(heights, weights, kStep, 0.012);
  for (int i = 0; i < 600; ++i) {
    const double x = kStep * i;
    EXPECT_NEAR(course[static_cast<std::size_t>(i)], 1e-3 + 0.02 * x - 3 * x * x, 1e-9) << i;
  }
}

TEST(WeightsBySpeed, AreZeroAtRest) {
  const std::vector<double> weights = speedWeights({0, 0.015, 0.06, 0.06, 0.06});
  EXPECT_EQ(weights[0], 0);
  EXPECT_NEAR(weights[1], 0.5, 1e-12);
  EXPECT_NEAR(weights[2], 64. / 65, 1e-12);
  EXPECT_THROW(speedWeights({0, 0, 0, 0.05}), Error);
}

struct Part {
  double wrong = 0, truth = 0; // sums of squares
  double ratio() const { return std::sqrt(wrong / truth); }
};

// Parts of each stroke: 4 mm at either end, the slow samples in between, and the rest.
struct Parts {
  Part begin, end, slow, quick;
  double highest = 0; // over the truth's rms, at the ends
};

void judge(const TriangleMesh& mesh, std::uint32_t seed, Parts& parts) {
  constexpr double kRms = 60e-6, kCutoff = 8e-3, kEnd = 4e-3, kSlow = 0.02;
  SimulatedHand hand = scanPathsOver(mesh, seed, 20, 0.05);
  hand.relief = [shape = hand.relief, rough = roughSurface(seed, kRms)](const Vec2& place) {
    return shape(place) + rough(place);
  };
  const ProbeModel probe;
  const SurfaceTarget target(mesh, 0, true);
  const std::vector<CameraPose> poses = simulateCamera(hand, probe, {}, seed);
  const std::vector<ProbeSample> samples = simulateProbe(hand, probe, {}, seed + 1);
  Progress progress;
  const ScanFilter filter;
  const FilteredScan scan = filterScan(poses, samples, probe, filter, progress);
  const auto yielding = complianceOverMesh(target, Pose::Identity(), scan.path);
  const std::vector<ScanHeight> heights =
      heightsOverMesh(target, Pose::Identity(), scan.path,
                      scanHeights(scan, poses, probe, filter.gravity,
                                  meanNormal(target, Pose::Identity(), scan.path),
                                  yielding ? yielding->compliance : 0));
  for (std::size_t first = 0, last = 0; first < heights.size(); first = last) {
    std::vector<ProfilePoint> points;
    for (; last < heights.size() && heights[last].stretch == heights[first].stretch; ++last)
      points.push_back(heights[last].point);
    const double length = points.back().arc_length;
    if (length < 0.03) continue;
    FitOptions1d options;
    options.harmonics = static_cast<int>(length / 0.6e-3); // the roughness' shortest wave, and more
    options.cutoff = kCutoff;
    const FittedTexture fitted = fitTexture(points, options);
    double before = -1;
    for (std::size_t i = first; i < last; ++i) {
      const double along = heights[i].point.arc_length;
      if (along - before < 0.1e-3) continue; // each position once
      before = along;
      const HandState state = handAt(hand, heights[i].t);
      const Vec3 unloaded =
          state.tip + hand.compliance * state.force * hand.normal(state.tip.head<2>());
      const double truth = target.residual(unloaded).distance;
      const double found = height(fitted.texture, along);
      const bool ends = along < kEnd || along > length - kEnd;
      Part& part = along < kEnd                      ? parts.begin
                   : along > length - kEnd           ? parts.end
                   : *heights[i].point.speed < kSlow ? parts.slow
                                                     : parts.quick;
      part.wrong += (found - truth) * (found - truth);
      part.truth += truth * truth;
      if (ends) parts.highest = std::max(parts.highest, std::abs(found) / kRms);
    }
  }
}

// Errors from a landing, a turn or a lift-off would be many times the texture.
TEST(ScanTexture, IsAsAccurateAtLandingTurningAndLiftingAsBetween) {
  TriangleMesh toy = dinosaur();
  for (Vec3& p : toy.positions) p *= 2;
  const Pose side(rotationFromTo(-Vec3::UnitY(), Vec3::UnitZ()));
  toy = transformed(toy, Eigen::Affine3d(side.matrix()));
  for (const TriangleMesh& mesh : {toy, icosphere(0.04, 60)}) {
    Parts parts;
    for (const std::uint32_t seed : {1, 2, 3, 4}) judge(mesh, seed, parts);
    std::printf(
        "wrong over true rms: begin %.2f, end %.2f, slow inside %.2f, between %.2f; highest "
        "at an end %.1f rms\n",
        parts.begin.ratio(), parts.end.ratio(), parts.slow.ratio(), parts.quick.ratio(),
        parts.highest);
    EXPECT_LT(parts.quick.ratio(), 0.8); // 0.71, 0.66
    for (const Part& part : {parts.begin, parts.end, parts.slow})
      EXPECT_LT(part.ratio(), 2 * parts.quick.ratio());
    EXPECT_LT(parts.highest, 4); // 1.9
  }
}

} // namespace
} // namespace patina
