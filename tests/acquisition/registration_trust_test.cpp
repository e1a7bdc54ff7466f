// Statements of a registration about itself: alternative poses, precision and the compliance of the
// surface.
#include <cstdio>

#include <gtest/gtest.h>

#include "acquisition/registration/register_path.h"
#include "acquisition/registration_shapes.h"
#include "core/decompose.h"

namespace patina {
namespace {

using test::Draw;
using test::missOf;

constexpr double kTrustNoise = 1e-4; // [m]

// A half turn about z maps the body onto itself.
TriangleMesh twofold() {
  TriangleMesh mesh = icosphere(1, 40);
  for (Vec3& p : mesh.positions) {
    p *= 0.035 + 0.008 * p.x() * p.y() + 0.004 * std::sin(3 * p.z()) + 0.004 * p.x() * p.x();
    p.x() *= 1.3;
  }
  return mesh;
}

Registration compared(const SurfaceTarget& target, std::vector<Vec3> path, Draw& draw) {
  for (Vec3& p : path) p += draw.normal(kTrustNoise);
  RegistrationOptions options;
  options.noise = kTrustNoise;
  options.alternatives = true;
  Progress progress;
  return registerPath(target, path, draw.off(path, 5, 2e-3), options, progress);
}

// T-A29
TEST(Rivals, IncludeTheHalfTurnOfASymmetricBody) {
  const SurfaceTarget target(twofold(), 0);
  Draw draw(21);
  for (int round = 0; round < 3; ++round) {
    const auto truth = draw.pathOn(target, 300);
    const Registration found = compared(target, truth, draw);
    ASSERT_TRUE(found.alternatives.has_value());
    ASSERT_EQ(found.alternatives->size(), 1U);
    const AlternativePose& rival = found.alternatives->front();
    const Pose half(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ()));
    EXPECT_LT(missOf(half * rival.mesh_from_path, truth), 0.5e-3);
    EXPECT_NEAR(rival.rotation, std::numbers::pi, 0.02);
    EXPECT_GT(rival.displacement, 0.02);
    EXPECT_NEAR(rival.rms, found.rms, 0.2 * found.rms);
    EXPECT_NE(inWords(*found.alternatives).find("another place"), std::string::npos);
  }
}

TEST(Rivals, AreAbsentForALongPathOnAnAsymmetricBody) {
  const SurfaceTarget target(test::lumpy(), 0);
  Draw draw(22);
  for (int round = 0; round < 3; ++round) {
    const auto truth = draw.pathOn(target, 300);
    const Registration found = compared(target, truth, draw);
    ASSERT_TRUE(found.alternatives.has_value());
    EXPECT_TRUE(found.alternatives->empty()) << inWords(*found.alternatives);
    EXPECT_LT(missOf(found.mesh_from_path, truth), 0.2e-3);
  }
}

TEST(Rivals, AreManyForAFewMillimetresOfPath) {
  const SurfaceTarget target(test::lumpy(), 0);
  Draw draw(23);
  std::vector<Vec3> path;
  for (int i = 0; i < 200; ++i)
    path.push_back(target.tree()
                       .closestPoint(Vec3(0.01 * std::sin(0.03 * i), 0.008 * std::cos(0.05 * i), 1))
                       .point);
  EXPECT_GT(compared(target, path, draw).alternatives->size(), 2U);
}

// Motions that a ball does not determine are no alternative pose, however far they lead.
TEST(Rivals, ExcludeUnobservableMotions) {
  const SurfaceTarget target(icosphere(0.04, 60), 0);
  Draw draw(24);
  const Registration found = compared(target, draw.pathOn(target, 300), draw);
  EXPECT_EQ(found.free.size(), 3U);
  EXPECT_TRUE(found.alternatives->empty()) << inWords(*found.alternatives);
}

TEST(Rivals, AreSearchedOnlyOnRequest) {
  const SurfaceTarget target(test::lumpy(12), 0);
  Draw draw(25);
  const auto truth = draw.pathOn(target, 100);
  Progress progress;
  EXPECT_FALSE(
      registerPath(target, truth, Pose::Identity(), {}, progress).alternatives.has_value());
}

TEST(Rivals, CountARejectedSampleLikeOneAtTheThreshold) {
  ResidualNoiseModel law;
  law.deviation = 1e-4;
  law.correlation_length = 10;
  std::vector<SurfaceResidual> misses(100);
  EXPECT_EQ(costOf(misses, law), 0);
  for (int i = 0; i < 18; ++i) misses[static_cast<std::size_t>(i)].distance = 5e-3;
  EXPECT_NEAR(costOf(misses, law), 18 * 9 / 10., 1e-9);
}

// On a flat face a constant force is equivalent to a shift along the normal.
TEST(ResidualNoiseModel, ConstantForceLeavesErrorBarsFinite) {
  const SurfaceTarget target(sheet(0.1, 0.08, 20), 0);
  Draw draw(27);
  const auto truth = draw.pathOn(target, 400);
  auto path = truth;
  for (Vec3& p : path) p += draw.normal(kTrustNoise);
  RegistrationOptions options;
  options.noise = kTrustNoise;
  options.force.assign(path.size(), 1.0);
  Progress progress;
  const Registration fit = registerPath(target, path, Pose::Identity(), options, progress);
  EXPECT_TRUE(fit.covariance.allFinite());
  EXPECT_NEAR(fit.correlation_length, 1, 0.5);
  EXPECT_NEAR(fit.rms, kTrustNoise, 0.2 * kTrustNoise);
}

// Errors are the mean of `width` draws in a row: their integrated autocorrelation is the width,
// in closed form. T-A28
TEST(ResidualNoiseModel, ErrorBarsHoldUnderCorrelatedErrors) {
  const SurfaceTarget target(test::lumpy(), 0);
  Draw draw(26);
  const auto truth = draw.pathOn(target, 800);
  for (const int width : {1, 20, 60}) {
    double squares = 0, together = 0, alone = 0;
    const int rounds = 40;
    for (int round = 0; round < rounds; ++round) {
      std::vector<Vec3> drawn(truth.size() + static_cast<std::size_t>(width));
      for (Vec3& v : drawn) v = draw.normal(kTrustNoise * std::sqrt(width));
      auto path = truth;
      for (std::size_t i = 0; i < path.size(); ++i)
        for (int k = 0; k < width; ++k) path[i] += drawn[i + static_cast<std::size_t>(k)] / width;
      RegistrationOptions options;
      options.noise = kTrustNoise;
      Progress progress;
      const Registration fit =
          registerPath(target, path, draw.off(truth, 3, 1e-3), options, progress);
      const Eigen::AngleAxisd turn(fit.mesh_from_path.linear());
      Vec6 error;
      error << turn.angle() * turn.axis(), fit.mesh_from_path * fit.middle - fit.middle;
      squares += error.dot(SymmetricSolver(fit.covariance).solve(error)) / 6 / rounds;
      together += fit.correlation_length / rounds;
      alone += fit.rms / rounds;
    }
    std::printf("%d alike: NEES %.2f, worth one %.1f, rms %.4f mm\n", width, squares, together,
                1e3 * alone);
    EXPECT_GT(squares, 0.5);
    EXPECT_LT(squares, 2);
    EXPECT_GT(together, 0.5 * width);
    EXPECT_LT(together, 2.0 * width + 1);
  }
}

// The same without a mesh, where the fit is linear: the error of the pose in the metric of its
// normal equations over the stated one. Blocks are as long as the correlation of the errors,
// shorter and longer. T-A28
TEST(ResidualNoiseModel, StatedVarianceHoldsForAnyBlockBoundaries) {
  for (const int n : {800, 1655, 5327})
    for (const int width : {1, 4, 8, 12, 24, 60}) {
      Draw draw(7);
      double actual = 0, stated = 0, together = 0;
      const int rounds = 16;
      for (int round = 0; round < rounds; ++round) {
        const Vec3 phase(draw.uniform(0, 6), draw.uniform(0, 6), draw.uniform(0, 6));
        std::vector<Vec3> points;
        PathFit fit;
        fit.weights.assign(static_cast<std::size_t>(n), 1);
        std::vector<double> drawn;
        for (int i = 0; i < n + width; ++i) drawn.push_back(draw.normal(kTrustNoise).x());
        Eigen::VectorXd errors(n);
        for (int i = 0; i < n; ++i) {
          const double u = 6.2 * i / n;
          const Vec3 d = Vec3(std::sin(u + phase.x()), std::sin(2 * u + phase.y()),
                              std::sin(3 * u + phase.z()))
                             .normalized();
          points.emplace_back(0.045 * d.x(), 0.035 * d.y(), 0.03 * d.z());
          const Vec3& p = points.back(); // a point whose normal is tilted by bumps
          SurfaceResidual miss;
          miss.direction =
              (Vec3(d.x() / 0.045, d.y() / 0.035, d.z() / 0.03).normalized() +
               0.35 * Vec3(std::sin(150 * p.y()), std::cos(130 * p.z()), std::sin(170 * p.x())))
                  .normalized();
          fit.residuals.push_back(miss);
          errors[i] = 0;
          for (int k = 0; k < width; ++k)
            errors[i] += drawn[static_cast<std::size_t>(i + k)] / std::sqrt(width);
        }
        const PoseScaling scale = scaleOf(points, Pose::Identity());
        Eigen::MatrixXd design(n, 6);
        for (int i = 0; i < n; ++i) {
          const auto at = static_cast<std::size_t>(i);
          design.row(i) << ((points[at] - scale.centre).cross(fit.residuals[at].direction) /
                            scale.radius)
                               .transpose(),
              fit.residuals[at].direction.transpose();
        }
        const Mat6 normal = design.transpose() * design;
        const Vec6 off = SymmetricSolver(normal).solve(design.transpose() * errors);
        errors -= design * off;
        for (int i = 0; i < n; ++i) fit.residuals[static_cast<std::size_t>(i)].distance = errors[i];
        fit.rms = std::sqrt(errors.squaredNorm() / n);
        const ResidualNoiseModel law = fitNoiseModel(points, fit, 1e-9);
        actual += off.dot(normal * off) / rounds;
        stated +=
            (normal * law.covariance(Eigen::Matrix<double, 6, Eigen::Dynamic>(6, 0))).trace() /
            rounds;
        together += law.correlation_length / rounds;
      }
      std::printf("%d points, %d alike: variance %.2f of what is stated, worth one %.1f\n", n,
                  width, actual / stated, together);
      EXPECT_GT(actual / stated, 0.45); // .55 to 1.36 of 16 rounds
      EXPECT_LT(actual / stated, 1.5);
    }
}

// Each sample is repeated four times with its error: the correlation length still counts samples.
TEST(ResidualNoiseModel, CorrelationLengthCountsSamplesAfterDownsampling) {
  const SurfaceTarget target(test::lumpy(), 0);
  Draw draw(29);
  const auto truth = draw.pathOn(target, 300);
  std::vector<Vec3> once, often;
  for (const Vec3& p : truth) {
    once.push_back(p + draw.normal(kTrustNoise));
    often.insert(often.end(), 4, once.back());
  }
  RegistrationOptions options;
  options.noise = kTrustNoise;
  const Pose start = draw.off(truth, 3, 1e-3);
  Progress progress;
  const Registration one = registerPath(target, once, start, options, progress);
  options.sample_spacing = 1e-9;
  const Registration four = registerPath(target, often, start, options, progress);
  EXPECT_NEAR(four.correlation_length, 4 * one.correlation_length, 1e-9 * four.correlation_length);
  EXPECT_TRUE(four.covariance.isApprox(one.covariance, 1e-6));
}

// T-A30
TEST(ComplianceFit, FindsComplianceTogetherWithThePose) {
  const SurfaceTarget target(test::lumpy(), 0, true);
  Draw draw(27);
  const auto truth = draw.pathOn(target, 400);
  const double compliance = 4e-4; // [m/N]
  RegistrationOptions options;
  options.noise = kTrustNoise;
  std::vector<Vec3> path;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    options.force.push_back(1 + 0.5 * std::sin(0.07 * static_cast<double>(i)));
    const std::int32_t face = target.tree().closestPoint(truth[i]).surface.face;
    path.push_back(truth[i] -
                   compliance * options.force.back() * faceNormal(target.mesh(), index(face)) +
                   draw.normal(kTrustNoise));
  }
  Progress progress;
  const Registration found =
      registerPath(target, path, draw.off(truth, 5, 2e-3), options, progress);
  EXPECT_NEAR(found.compliances.at(0), compliance, 0.1 * compliance);
  EXPECT_NEAR(found.rms, kTrustNoise, 0.2 * kTrustNoise);
  EXPECT_LT(missOf(found.mesh_from_path, truth), 0.1e-3);
  // A hard surface has no compliance to find.
  for (std::size_t i = 0; i < truth.size(); ++i) path[i] = truth[i] + draw.normal(kTrustNoise);
  const Registration hard = registerPath(target, path, draw.off(truth, 5, 2e-3), options, progress);
  EXPECT_LT(hard.compliances.at(0), 0.1 * compliance);
  options.force.pop_back();
  EXPECT_THROW(registerPath(target, path, Pose::Identity(), options, progress),
               std::invalid_argument);
}

// Squared errors of the compliance over its stated variance, of 60 draws. T-A30
TEST(ComplianceFit, StatesTheDeviationOfTheCompliance) {
  const SurfaceTarget target(test::lumpy(), 0, true);
  Draw draw(29);
  const auto truth = draw.pathOn(target, 300);
  const double compliance = 4e-4; // [m/N]
  RegistrationOptions options;
  options.noise = kTrustNoise;
  options.search = false;
  std::vector<Vec3> pressed;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    options.force.push_back(1 + 0.5 * std::sin(0.07 * static_cast<double>(i)));
    const std::int32_t face = target.tree().closestPoint(truth[i]).surface.face;
    pressed.push_back(truth[i] -
                      compliance * options.force.back() * faceNormal(target.mesh(), index(face)));
  }
  double squares = 0;
  constexpr int kRounds = 60;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Vec3> path = pressed;
    for (Vec3& p : path) p += draw.normal(kTrustNoise);
    Progress progress;
    const Registration found =
        registerPath(target, path, draw.off(truth, 3, 1e-3), options, progress);
    const double off = found.compliances.at(0) - compliance;
    squares += std::pow(off / found.compliance_deviations.at(0), 2) / kRounds;
  }
  std::printf("squared errors over stated variance: %.2f\n", squares);
  EXPECT_GT(squares, 0.5);
  EXPECT_LT(squares, 2);
}

// One half is higher where the probe presses harder, which looks like a larger compliance there; it
// must not affect the pose that is found next.
TEST(ComplianceFit, ResetsComplianceAtAnotherPose) {
  const double compliance = 4e-4; // [m/N]
  const auto force = [](const Vec3& p) { return 1 + 0.5 * std::sin(300 * p.z()); };
  TriangleMesh mesh = twofold();
  for (Vec3& p : mesh.positions)
    if (p.x() < 0)
      p += (0.15 * compliance * force(p) + 1.5e-4 * std::cos(500 * p.z())) * p.normalized();
  const SurfaceTarget target(std::move(mesh), 0, true);
  Draw draw(28);
  std::vector<Vec3> truth, path;
  RegistrationOptions options;
  options.noise = kTrustNoise;
  options.alternatives = true;
  options.search_options.rotation = std::numbers::pi;
  for (const Vec3& p : draw.pathOn(target, 900)) {
    if (p.x() < 4e-3) continue;
    const std::int32_t face = target.tree().closestPoint(p).surface.face;
    truth.push_back(p);
    options.force.push_back(force(p));
    path.push_back(p - compliance * force(p) * faceNormal(target.mesh(), index(face)) +
                   draw.normal(kTrustNoise));
  }
  ASSERT_GT(path.size(), 300U);
  const Pose half(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ()));
  Progress progress;
  const Registration found = registerPath(target, path, half, options, progress);
  EXPECT_LT(missOf(found.mesh_from_path, truth), 0.2e-3);
  EXPECT_NEAR(found.compliances.at(0), compliance, 0.1 * compliance);
}

} // namespace
} // namespace patina
