// Limits of the fixed contact test: accuracy from one run, times against a reference.
#include "app/studies/haptics/contact_test_path.h"
#include "benchmarks/tick_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace patina {
namespace {

constexpr double kBall = 0.05;
constexpr double kTip = 0.02;
// Fields are made once: the finest takes seconds.
const std::shared_ptr<const SurfaceField>& sphereOf(int frequency, double crack = 0) {
  static std::map<std::pair<int, double>, std::shared_ptr<const SurfaceField>> made;
  auto& field = made[{frequency, crack}];
  if (!field) {
    Progress progress;
    field = frequency ? meshSphere(kBall, frequency, crack, progress) : analyticSphere(kBall);
  }
  return field;
}
constexpr int kAnalytic = 0, k1k = 7, k10k = 22, k100k = 71, k1M = 224;

std::shared_ptr<const HapticSnapshot> snapshotOf(int frequency, const ContactTestSpec& spec) {
  return compileStages(contactTestScene(spec), sphereOf(frequency));
}

ContactTestErrors errorsOf(int frequency, const ContactTestSpec& spec, double crack = 0) {
  const auto snapshot = compileStages(contactTestScene(spec), sphereOf(frequency, crack));
  const ContactTestErrors errors = contactTestErrors(*snapshot, makeContactTest(spec));
  EXPECT_EQ(errors.lost, 0); // F.n < K d / 2 counts
  EXPECT_EQ(errors.faults, 0);
  std::printf(
      "direction %.2g (max %.2g) degrees, magnitude %.2g (max %.2g) %%, jump %.2g, Coulomb %.5f\n",
      errors.direction_mean, errors.direction_max, errors.magnitude_mean, errors.magnitude_max,
      errors.jump_rms, errors.coulomb_ratio);
  return errors;
}

class ContactBenchmark : public testing::TestWithParam<double> {}; // tip radius, fractions of R
INSTANTIATE_TEST_SUITE_P(Tips, ContactBenchmark, testing::Values(0.0, kTip));

TEST_P(ContactBenchmark, AnalyticSphere) {
  const ContactTestErrors high = errorsOf(kAnalytic, {.tip_radius = GetParam()});
  EXPECT_LE(high.direction_mean, 0.005);
  EXPECT_LE(high.direction_max, 0.02);
  EXPECT_LE(high.magnitude_mean, 3e-4);
  EXPECT_LE(high.magnitude_max, 2.5e-3);
  const ContactTestErrors kim =
      errorsOf(kAnalytic, {.tip_radius = GetParam(), .sampler = Sampler::kim});
  EXPECT_LE(kim.direction_mean, 0.005);
  EXPECT_LE(kim.direction_max, 0.02);
}

TEST_P(ContactBenchmark, SphereOf100kTriangles) {
  const ContactTestErrors high = errorsOf(k100k, {.tip_radius = GetParam()});
  EXPECT_LE(high.direction_mean, 0.017);
  EXPECT_LE(high.direction_max, 0.08);
  EXPECT_LE(high.magnitude_mean, 0.17); // the error of the facets
  EXPECT_LE(high.magnitude_max, 0.58);
}

TEST_P(ContactBenchmark, SphereOf1MTriangles) {
  const ContactTestErrors high = errorsOf(k1M, {.tip_radius = GetParam()});
  EXPECT_LE(high.magnitude_mean, 0.02);
  EXPECT_LE(high.magnitude_max, 0.07);
  EXPECT_LE(high.jump_rms, 1.25e-4);
  const ContactTestErrors kim = errorsOf(k1M, {.tip_radius = GetParam(), .sampler = Sampler::kim});
  EXPECT_LE(kim.magnitude_mean, 0.20);
  EXPECT_LE(kim.magnitude_max, 0.65);
}

TEST_P(ContactBenchmark, FrictionFollowsCoulomb) {
  for (const int surface : {kAnalytic, k100k}) {
    const ContactTestErrors paper = errorsOf(surface, {.tip_radius = GetParam(), .friction = true});
    EXPECT_NEAR(paper.coulomb_ratio, 0.3, 1.3e-3);
    EXPECT_LE(paper.direction_mean, 0.60);
    EXPECT_LE(paper.direction_max, 2.2);
    const ContactTestErrors displacement =
        errorsOf(surface, {.tip_radius = GetParam(),
                           .friction = true,
                           .slip = Friction::SlipDirection::displacement});
    EXPECT_NEAR(displacement.coulomb_ratio, 0.3, 1.3e-3);
    EXPECT_LE(displacement.direction_mean, 0.10);
    EXPECT_LE(displacement.direction_max, 0.30);
  }
}

TEST(ContactCracks, LoseNoTick) {
  for (const int surface : {k10k, k100k}) {
    const ContactTestErrors whole = errorsOf(surface, {});
    for (const double crack : {1e-4, 1e-3, 1e-2}) {
      const ContactTestErrors errors = errorsOf(surface, {}, crack);
      // At a hundredth of R the gap affects the distance itself: a tenth more is allowed there.
      const double allowance = crack > 5e-3 ? 1.1 : 1.02;
      EXPECT_LE(errors.direction_mean, allowance * whole.direction_mean) << crack;
      EXPECT_LE(errors.direction_max, allowance * whole.direction_max) << crack;
      EXPECT_LE(errors.magnitude_mean, allowance * whole.magnitude_mean) << crack;
      EXPECT_LE(errors.magnitude_max, allowance * whole.magnitude_max) << crack;
    }
  }
}

TEST_P(ContactBenchmark, ForceIsTheSameAtEverySize) {
  std::vector<Vec3> reference;
  for (const double radius : {0.05, 0.3, 2.0, 10.0}) {
    const ContactTestSpec spec{.radius = radius, .tip_radius = GetParam()};
    const auto snapshot = compileStages(contactTestScene(spec), analyticSphere(radius));
    const std::vector<Vec3> force = contactTestErrors(*snapshot, makeContactTest(spec)).force;
    if (reference.empty()) reference = force;
    double worst = 0;
    for (std::size_t i = 0; i < force.size(); ++i)
      worst = std::max(worst, (force[i] - reference[i]).norm() / reference[i].norm());
    // Where the last bit decides on one more evaluation, the force changes by the residual of an
    // evaluation.
    EXPECT_LE(worst, 3e-4) << radius;
  }
}

// The same from triangles: the tree's unit is the mesh's own size, and stored distances are
// measured in double, so that only double's last bit depends on the scale.
TEST(ContactScale, ForceIsTheSameAtEverySizeOfMesh) {
  std::vector<Vec3> reference;
  for (const double radius : {0.05, 0.8, 12.8, 1.0, 10.0}) {
    Progress progress;
    const ContactTestSpec spec{.radius = radius};
    const auto snapshot =
        compileStages(contactTestScene(spec), meshSphere(radius, k10k, 0, progress));
    const std::vector<Vec3> force = contactTestErrors(*snapshot, makeContactTest(spec)).force;
    if (reference.empty()) reference = force;
    double worst = 0;
    for (std::size_t i = 0; i < force.size(); ++i)
      worst = std::max(worst, (force[i] - reference[i]).norm() / reference[i].norm());
    std::printf("R = %g m: %.2g\n", radius, worst);
    // On facets the last bit decides where a proxy's step ends, to 3e-4 voxel, which is 4e-4 of the
    // smallest depth: 7.6e-5 measured.
    EXPECT_LE(worst, 2.2e-4) << radius;
  }
}

// Largest time of a tick in reference ticks: 3 times the measured value, which stands beside it.
struct TickRow {
  const char* name;
  int surface;
  ContactTestSpec spec;
  double p50, p99;
};
const TickRow kTickRows[] = {
    {"friction, 980 triangles", k1k, {.friction = true}, 6, 7},                      // 2.0, 2.3
    {"friction, 9,680 triangles", k10k, {.friction = true}, 6, 7},                   // 2.0, 2.2
    {"friction, 100,820 triangles", k100k, {.friction = true}, 6, 7},                // 2.0, 2.2
    {"friction, 1,003,520 triangles", k1M, {.friction = true}, 6, 7},                // 2.0, 2.0
    {"finite tip, 1,003,520 triangles", k1M, {.tip_radius = kTip}, 4.5, 5},          // 1.4, 1.4
    {"finite tip with friction", k1M, {.tip_radius = kTip, .friction = true}, 6, 7}, // 2.0, 2.0
};

PATINA_TIMED_TEST(ContactTiming, TickIsFastForAnyMeshAndTip) {
  for (const TickRow& row : kTickRows) {
    const test::TickTime time =
        test::tickTime(*snapshotOf(row.surface, row.spec), makeContactTest(row.spec));
    EXPECT_TRUE(test::within(row.name, time.tick.p50, time.reference.p50, row.p50));
    EXPECT_TRUE(test::within("  p99", time.tick.p99, time.reference.p99, row.p99));
  }
}

PATINA_TIMED_TEST(ContactTiming, TickWithFrictionTakesTheSameAtAnySizeOfMesh) {
  const ContactTestSpec spec{.friction = true};
  std::vector<std::shared_ptr<const HapticSnapshot>> snapshots;
  for (const int surface : {k1k, k10k, k100k, k1M}) snapshots.push_back(snapshotOf(surface, spec));
  const std::vector<double> seconds = test::pathSeconds(snapshots, makeContactTest(spec));
  EXPECT_TRUE(test::within("the slowest of four sizes of mesh, against the quickest",
                           *std::max_element(seconds.begin(), seconds.end()),
                           *std::min_element(seconds.begin(), seconds.end()), 1.8)); // 1.45: facets
}

} // namespace
} // namespace patina
