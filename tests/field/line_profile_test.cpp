#include "field/sampling/line_profile.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "core/error.h"

namespace patina {
namespace {

constexpr double kBall = 0.03; // radius [m]

std::shared_ptr<const SurfaceField> ballForLines() {
  FieldSpec spec;
  spec.resolution = 80;
  const Box3 box(Vec3::Constant(-kBall), Vec3::Constant(kBall));
  return withSamples(std::make_shared<const SurfaceField>(sampleFunction(
      [](const Vec3& p) { return p.norm() - kBall; }, gridAround(box, spec), spec.band)));
}

TEST(LineProfile, OfABallIsTheDistanceToItsCentreMinusTheRadius) {
  const auto field = ballForLines();
  const FieldSampler sampler(*field, Sampler::high);
  const Vec3 from(0.026, -0.002, 0.001), to(0.034, 0.003, 0.004);
  const auto profile = profileAlong(sampler, from, to, 101);
  ASSERT_EQ(profile.size(), 101U);
  EXPECT_EQ(profile.front().point, from);
  EXPECT_NEAR((profile.back().point - to).norm(), 0, 1e-12);
  EXPECT_NEAR(profile.back().along, (to - from).norm(), 1e-12);
  for (const LineSample& sample : profile)
    ASSERT_NEAR(sample.phi, sample.point.norm() - kBall, 2e-6) << sample.along;
}

TEST(LineProfile, HasNoValueBeyondTheBandAndNeedsTwoEnds) {
  const auto field = ballForLines();
  const FieldSampler sampler(*field, Sampler::high);
  const auto profile = profileAlong(sampler, Vec3(kBall, 0, 0), Vec3(10, 0, 0), 3);
  EXPECT_TRUE(std::isnan(profile.back().phi));
  EXPECT_NEAR(profile.front().phi, 0, 1e-5);
  EXPECT_THROW(profileAlong(sampler, Vec3::Ones(), Vec3::Ones(), 5), Error);
}

} // namespace
} // namespace patina
