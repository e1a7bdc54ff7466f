// Heights and stiffness of a whole scan against the simulated hand.
#include "acquisition/profile/scan_heights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "acquisition/filtering/filtered_scan.h"
#include "acquisition/profile/roughness.h"
#include "acquisition/simulation/simulated_streams.h"
#include "acquisition/simulation/simulated_surface.h"
#include "core/error.h"
#include "core/percentiles.h"

namespace patina {
namespace {

struct Rough {
  SimulatedHand hand;
  ScanHeights found;
};

Rough roughScan(std::uint32_t seed, double rms, const SimulatedProbe& stream = {}) {
  Rough rough;
  rough.hand = strokes(seed);
  rough.hand.relief = roughSurface(seed, rms);
  const ProbeModel probe;
  const ScanFilter filter;
  Progress progress;
  const std::vector<CameraPose> poses = simulateCamera(rough.hand, probe, {}, seed);
  rough.found = scanHeights(filterScan(poses, simulateProbe(rough.hand, probe, stream, seed + 100),
                                       probe, filter, progress),
                            poses, probe, filter.gravity);
  return rough;
}

// Values minus their mean over 0.1 s, which is the part that accelerometers observe.
std::vector<double> quick(const std::vector<double>& values) {
  constexpr std::size_t kReach = 25;
  std::vector<double> sums{0}, rest;
  for (const double value : values) sums.push_back(sums.back() + value);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t low = i < kReach ? 0 : i - kReach,
                      high = std::min(i + kReach + 1, values.size());
    rest.push_back(values[i] - (sums[high] - sums[low]) / static_cast<double>(high - low));
  }
  return rest;
}

double squares(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum;
}

struct HeightError {
  double quick = 0; // rms of the high frequencies, relative to the truth
  double nees = 0;
};

HeightError errorOf(const Rough& rough) {
  HeightError error;
  double quick_error = 0, quick_truth = 0;
  const std::vector<ScanHeight>& heights = rough.found.heights;
  for (std::size_t begin = 0, end = 0; begin < heights.size(); begin = end) {
    std::vector<double> wrong, truth;
    for (; end < heights.size() && heights[end].stretch == heights[begin].stretch; ++end) {
      truth.push_back(handAt(rough.hand, heights[end].t).surface);
      wrong.push_back(heights[end].point.height - truth.back());
    }
    double mean = 0; // the offset of the plane does not count
    for (const double each : wrong) mean += each / static_cast<double>(wrong.size());
    for (std::size_t i = 0; i < wrong.size(); ++i)
      error.nees += std::pow((wrong[i] - mean) / heights[begin + i].point.sigma, 2) /
                    static_cast<double>(heights.size());
    quick_error += squares(quick(wrong));
    quick_truth += squares(quick(truth));
  }
  error.quick = std::sqrt(quick_error / quick_truth);
  return error;
}

TEST(ScanHeights, MatchTheSurfaceUnderTheTip) {
  for (const std::uint32_t seed : {1, 2, 3}) {
    const Rough rough = roughScan(seed, 50e-6);
    const HeightError error = errorOf(rough);
    std::printf("seed %u: %.2f of the truth above 10 Hz, NEES %.2f, %zu presses\n", seed,
                error.quick, error.nees,
                rough.found.compliance ? rough.found.compliance->loadings : 0);
    EXPECT_GT(rough.found.heights.size(), 4000u);
    EXPECT_LT(error.quick, 0.4);
    EXPECT_GT(error.nees, 0.4);
    EXPECT_LT(error.nees, 2);
  }
}

// A press moves a resting tip by a millimetre, and none of it may become texture.
TEST(ScanHeights, AreFreeOfTheCompliance) {
  for (const double stiffness : {1000., 3000.}) {
    Rough rough;
    rough.hand.seed = 3;
    rough.hand.relief = roughSurface(3, 50e-6);
    rough.hand.compliance = 1 / stiffness;
    rough.hand.moves = {{Vec2::Zero(), 0.5, 0, 0, 0}};
    for (int i = 0; i < 4; ++i) {
      rough.hand.moves.push_back({Vec2::Zero(), 0.6, 0, 4, 0});
      rough.hand.moves.push_back({Vec2::Zero(), 0.4, 0, 0.6, 0});
    }
    rough.hand.moves.push_back({Vec2(0.06, 0.01), 1, 0, 1, 0});
    rough.hand.moves.push_back({Vec2(0.06, 0.01), 0.5, 0, 0, 1});
    const ProbeModel probe;
    const ScanFilter filter;
    Progress progress;
    const std::vector<CameraPose> poses = simulateCamera(rough.hand, probe, {}, 5);
    rough.found = scanHeights(
        filterScan(poses, simulateProbe(rough.hand, probe, {}, 6), probe, filter, progress), poses,
        probe, filter.gravity, Vec3::UnitZ());
    // The path of the tip.
    std::vector<ScanHeight>& heights = rough.found.heights;
    std::erase_if(heights,
                  [&](const ScanHeight& height) { return height.t < 4.6 || height.t > 5.4; });
    const double error = errorOf(rough).quick;
    std::printf("%.0f N/m: %.2f of the truth above 10 Hz\n", stiffness, error);
    EXPECT_LT(error, 0.3);
  }
}

// A sine of one wavelength, of which a Gaussian of this cutoff passes a known part.
TEST(Roughness, MatchesTheClosedFormForASine) {
  constexpr double kSize = 10e-6, kCutoff = 2.5e-3;
  for (const double length : {0.5e-3, 1.25e-3, 2.5e-3}) {
    std::vector<ScanHeight> heights;
    for (int stretch = 0; stretch < 2; ++stretch)
      for (int i = 0; i < 20000; ++i) {
        const double along = 5e-6 * i;
        heights.push_back({0,
                           {along, kSize * std::sin(2 * M_PI * along / length), 0},
                           static_cast<std::size_t>(stretch)});
      }
    const auto found = roughnessOf(heights, kCutoff);
    ASSERT_TRUE(found);
    const double left = 1 - std::exp(-std::log(2.) * std::pow(kCutoff / length, 2));
    // The path is sampled at a twenty-fifth of the cutoff: chords miss the sine by a few percent.
    EXPECT_NEAR(found->rq, left * kSize / std::sqrt(2.), 0.03 * kSize) << length;
    EXPECT_NEAR(found->ra, left * 2 * kSize / M_PI, 0.03 * kSize) << length;
    EXPECT_LT(found->rq_deviation, 0.02 * kSize);
    EXPECT_GE(found->lengths, 76u);
  }
  EXPECT_FALSE(roughnessOf({}, kCutoff));
}

// The roughness of a scan against that of the scanned surface, and the means of white noise against
// their stated deviation.
TEST(Roughness, MatchesTheScannedSurfaceAndItsDeviationHolds) {
  for (const std::uint32_t seed : {1, 2, 3}) {
    const Rough rough = roughScan(seed, 50e-6);
    std::vector<ScanHeight> truth = rough.found.heights;
    for (ScanHeight& height : truth) height.point.height = handAt(rough.hand, height.t).surface;
    const auto found = roughnessOf(rough.found.heights), known = roughnessOf(truth);
    ASSERT_TRUE(found && known);
    std::printf("seed %u: Rq %.1f +- %.1f um of %.1f, Ra %.1f +- %.1f of %.1f\n", seed,
                1e6 * found->rq, 1e6 * found->rq_deviation, 1e6 * known->rq, 1e6 * found->ra,
                1e6 * found->ra_deviation, 1e6 * known->ra);
    EXPECT_NEAR(found->rq, known->rq, 0.05 * known->rq);
    EXPECT_NEAR(found->ra, known->ra, 0.05 * known->ra);
  }
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1e-5);
  double pulls = 0, mean = 0;
  constexpr int kSeeds = 200;
  std::vector<RoughnessEstimate> estimates;
  for (int i = 0; i < kSeeds; ++i) {
    std::vector<ScanHeight> heights;
    for (int k = 0; k < 1000; ++k) heights.push_back({0, {1e-4 * k, normal(random), 0}, 0});
    estimates.push_back(*roughnessOf(heights));
    mean += estimates.back().rq / kSeeds;
  }
  for (const RoughnessEstimate& estimate : estimates)
    pulls += std::pow((estimate.rq - mean) / estimate.rq_deviation, 2) / kSeeds;
  std::printf("white: squared error over variance %.2f\n", pulls);
  EXPECT_GT(pulls, 0.6);
  EXPECT_LT(pulls, 1.5);
}

TEST(ScanHeights, FindThePlaneAndItsOutside) {
  const Rough rough = roughScan(4, 25e-6);
  EXPECT_GT(rough.found.plane.normal.z(), std::cos(0.01));
  EXPECT_NEAR(rough.found.plane.point.z(), 0, 1e-3);
}

TEST(ScanHeights, FindStiffnessWithinItsDeviation) {
  double pulls = 0, found = 0;
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    const Rough rough = roughScan(seed, 25e-6);
    if (!rough.found.compliance) continue;
    const ComplianceEstimate& estimate = *rough.found.compliance;
    found += 1;
    std::printf("seed %u: %.0f +- %.0f N/m, %zu presses, %zu samples\n", seed, estimate.stiffness,
                estimate.stiffness_deviation, estimate.loadings, estimate.samples);
    pulls +=
        std::pow((estimate.compliance - rough.hand.compliance) / estimate.compliance_deviation, 2);
  }
  ASSERT_GE(found, 10);
  std::printf("mean square over the deviation %.2f\n", pulls / found);
  EXPECT_LT(pulls / found, 3) << "chi^2 of one degree of freedom each, from few presses";
}

TEST(ScanHeights, AreOnTheCamerasClock) {
  SimulatedProbe late;
  late.clock_offset = 0.1;
  EXPECT_LT(errorOf(roughScan(5, 50e-6, late)).quick, 0.45);
}

std::vector<PathSample> touching(const std::vector<Vec3>& places) {
  std::vector<PathSample> path;
  for (const Vec3& place : places) {
    PathSample sample;
    sample.position = place;
    sample.touching = true;
    path.push_back(sample);
  }
  return path;
}

TEST(TouchedPlane, IsAbsentOnALineOrInTheAir) {
  std::vector<Vec3> line, ball;
  for (int i = 0; i < 500; ++i) {
    const double t = 0.05 * i;
    line.emplace_back(1e-3 * t, 1e-5 * std::sin(7 * t), 1e-5 * std::cos(9 * t));
    ball.emplace_back(std::sin(3 * t) * std::cos(t), std::sin(3 * t) * std::sin(t),
                      std::cos(3 * t));
  }
  const Vec3 tip = ProbeModel().tip;
  EXPECT_THROW(touchedPlane(touching(line), tip), Error);
  EXPECT_THROW(touchedPlane(touching(ball), tip), Error);
  EXPECT_THROW(touchedPlane(std::vector<PathSample>(500), tip), Error);
}

TEST(TouchedPlane, FacesTheShaft) {
  std::vector<Vec3> places;
  for (int i = 0; i < 100; ++i) places.emplace_back(0.01 * std::sin(i), 0.01 * std::cos(i), 0.3);
  std::vector<PathSample> path = touching(places);
  EXPECT_NEAR(touchedPlane(path, Vec3(0, 0, -0.1)).normal.z(), 1, 1e-12);
  EXPECT_NEAR(touchedPlane(path, Vec3(0, 0, 0.1)).normal.z(), -1, 1e-12);
}

} // namespace
} // namespace patina
