#include "acquisition/registration/register_path.h"

#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "acquisition/registration/iterated_closest_points.h"
#include "acquisition/registration_shapes.h"
#include "core/decompose.h"
#include "core/error.h"

namespace patina {
namespace {

using test::Draw;
using test::missOf;

std::vector<Vec3> noisy(std::vector<Vec3> path, Draw& draw, double noise) {
  for (Vec3& p : path) p += draw.normal(noise);
  return path;
}

Registration registered(const SurfaceTarget& target, const std::vector<Vec3>& path,
                        const Pose& start, const RegistrationOptions& options = {}) {
  Progress progress;
  return registerPath(target, path, start, options, progress);
}

TEST(SurfaceTarget, RefusesATipLargerThanTheMesh) {
  EXPECT_NO_THROW(SurfaceTarget(icosphere(0.04, 4), 0.02, true));
  try {
    const SurfaceTarget target(icosphere(0.04, 4), 0.5, true);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("is larger than the mesh"), std::string::npos)
        << error.what();
  }
}

TEST(Registration, IsExactWithoutNoise) {
  const SurfaceTarget target(test::lumpy(), 0);
  Draw draw(1);
  for (int round = 0; round < 20; ++round) {
    const auto truth = draw.pathOn(target, 300);
    const Registration found = registered(target, truth, draw.off(truth, 15, 0.01));
    EXPECT_LT(missOf(found.mesh_from_path, truth), 5e-8); // [m]
    EXPECT_TRUE(found.converged);
    EXPECT_TRUE(found.free.empty());
  }
}

// Ten seconds at rest on a ridge say no more about the pose than one second.
TEST(Registration, RestingSamplesCountOnceAfterDownsampling) {
  const SurfaceTarget target(test::lumpy(), 0);
  Draw draw(7);
  auto path = draw.pathOn(target, 300);
  const auto truth = path;
  const SurfaceResidual under = target.residual(truth[40]);
  const Vec3 ridge = truth[40] + 0.3e-3 * faceNormal(target.mesh(), index(under.foot.face));
  for (int i = 0; i < 5000; ++i) path.push_back(ridge);
  RegistrationOptions options;
  options.robust = false;
  const double each =
      missOf(registered(target, path, Pose::Identity(), options).mesh_from_path, truth);
  options.sample_spacing = 0.1e-3;
  const Registration found = registered(target, path, Pose::Identity(), options);
  const double once = missOf(found.mesh_from_path, truth);
  std::printf("each sample %.4f mm, each place %.4f mm\n", 1e3 * each, 1e3 * once);
  EXPECT_LT(once, 0.1 * each);
  ASSERT_EQ(found.residuals.size(), path.size());
  EXPECT_EQ(found.inliers.size(), path.size());
  EXPECT_NEAR(std::abs(found.residuals.back().distance), 0.3e-3, 0.05e-3);
}

// T-A10b, F11
TEST(Registration, ConvergesInSixStepsWhereTheLoopCreeps) {
  const SurfaceTarget target(test::bumpyPatch(), 0);
  std::vector<Vec3> truth;
  for (int i = 0; i < 200; ++i) {
    const double u = 2 * std::numbers::pi * i / 200;
    truth.push_back(target.tree()
                        .closestPoint(Vec3(0.03 * std::sin(u), 0.03 * std::sin(2 * u + 0.4), 0))
                        .point);
  }
  Pose start = Pose::Identity();
  start.translation() = Vec3(2e-3, -1.5e-3, 1e-3);
  FitOptions few;
  few.iterations = 6;
  EXPECT_LT(missOf(fitPath(target, truth, start, few).mesh_from_path, truth), 1e-10);

  IcpOptions creeping;
  creeping.iterations = 50;
  creeping.tolerance = 0;
  const IcpResult before = iteratedClosestPoints(target, truth, start, creeping);
  EXPECT_GT(missOf(before.mesh_from_path, truth), 1e-4);
  creeping.iterations = 51;
  const IcpResult after = iteratedClosestPoints(target, truth, start, creeping);
  EXPECT_GT(after.mean_distance / before.mean_distance, 0.95);          // looks like convergence
  EXPECT_GT(after.last_translation + 0.03 * after.last_rotation, 1e-6); // still moves
}

// T-A10a
TEST(Registration, MeanSquareOfTheLoopNeverGrows) {
  const SurfaceTarget target(test::lumpy(12), 0);
  Draw draw(2);
  for (int round = 0; round < 1000; ++round) {
    const auto path = noisy(draw.pathOn(target, 12), draw, 5e-4);
    const Pose start = draw.off(path, draw.uniform(0, 60), draw.uniform(0, 0.03));
    IcpOptions one;
    one.iterations = 1;
    IcpResult fit = iteratedClosestPoints(target, path, start, one);
    for (int step = 0; step < 8; ++step) {
      const IcpResult next = iteratedClosestPoints(target, path, fit.mesh_from_path, one);
      EXPECT_LE(next.mean_square, fit.mean_square * (1 + 1e-12));
      fit = next;
    }
  }
}

// T-A10d
TEST(Registration, FindsThePoseFromFarAway) {
  const SurfaceTarget target(test::lumpy(), 0);
  for (const double noise : {0.0, 5e-4}) {
    Draw draw(3);
    int found = 0;
    for (int round = 0; round < 40; ++round) {
      const auto truth = draw.pathOn(target, 300);
      const auto path = noisy(truth, draw, noise);
      RegistrationOptions options;
      options.noise = noise;
      found += missOf(registered(target, path, draw.off(truth, 60, 0.04), options).mesh_from_path,
                      truth) < 1e-3;
    }
    std::printf("noise %.1f mm: %d of 40\n", 1e3 * noise, found);
    EXPECT_GE(found, 38);
  }
}

TEST(Registration, ToleratesOneFifthOutliers) {
  const SurfaceTarget target(test::lumpy(), 0);
  for (const double degrees : {15, 30}) {
    Draw draw(4);
    int found = 0;
    for (int round = 0; round < 40; ++round) {
      const auto truth = draw.pathOn(target, 300);
      auto path = noisy(truth, draw, 5e-4);
      std::vector<bool> strayed(path.size(), false);
      for (std::size_t i = 0; i < path.size(); ++i)
        if (draw.uniform(0, 1) < 0.2) {
          path[i] += draw.uniform(5e-3, 20e-3) * draw.direction();
          strayed[i] = true;
        }
      RegistrationOptions options;
      options.noise = 5e-4;
      const Registration fit = registered(target, path, draw.off(truth, degrees, 0.01), options);
      found += missOf(fit.mesh_from_path, truth) < 1e-3;
      std::size_t far_ones = 0, taken = 0;
      for (std::size_t i = 0; i < path.size(); ++i)
        if (strayed[i] && target.tree().closestPoint(path[i]).distance > 4e-3) {
          ++far_ones;
          taken += fit.inliers[i];
        }
      EXPECT_LE(taken, far_ones / 20);
    }
    std::printf("%g degrees: %d of 40\n", degrees, found);
    EXPECT_GE(found, 39);
  }
}

// T-A10c
TEST(Registration, ReportsUnobservableMotions) {
  const auto kinds = [](const Registration& fit) {
    std::pair<int, int> count{0, 0}; // slides, turns
    for (const UnobservableMotion& motion : fit.free)
      ++(motion.kind == UnobservableMotion::Kind::translation ? count.first : count.second);
    return count;
  };
  for (const double noise : {0.0, 3e-4}) {
    Draw draw(5);
    RegistrationOptions options;
    options.noise = noise;
    { // a plane: two translations and a rotation about its normal
      const SurfaceTarget target(sheet(0.2, 0.2, 20), 0);
      std::vector<Vec3> path;
      for (int i = 0; i < 300; ++i)
        path.emplace_back(0.04 * std::sin(0.02 * i), 0.03 * std::sin(0.05 * i), 0);
      const Pose start = draw.off(path, 10, 5e-3);
      const Registration fit = registered(target, noisy(path, draw, noise), start, options);
      EXPECT_EQ(kinds(fit), std::pair(2, 1));
      for (const UnobservableMotion& motion : fit.free) {
        const double up = std::abs(motion.axis.z());
        EXPECT_NEAR(up, motion.kind == UnobservableMotion::Kind::rotation ? 1 : 0, 0.02);
      }
    }
    { // a sphere: three rotations about its centre
      const SurfaceTarget target(icosphere(0.04, 60), 0);
      const auto truth = draw.pathOn(target, 300);
      const Registration fit =
          registered(target, noisy(truth, draw, noise), draw.off(truth, 15, 0.01), options);
      EXPECT_EQ(kinds(fit), std::pair(0, 3));
      for (const UnobservableMotion& motion : fit.free) {
        EXPECT_LT(motion.axis_point.cross(motion.axis).norm(), 1e-3) << inWords(motion);
        EXPECT_LT(std::abs(motion.pitch), 1e-3);
      }
    }
    { // a tube: along and about its axis
      const SurfaceTarget target(test::tube(0.02, 0.3, 240, 60), 0);
      std::vector<Vec3> truth;
      for (int i = 0; i < 300; ++i) {
        const double u = 0.02 * i;
        truth.push_back(target.tree()
                            .closestPoint(Vec3(0.02 * std::cos(3 * u), 0.02 * std::sin(3 * u),
                                               0.03 * std::sin(u)))
                            .point);
      }
      const Registration fit =
          registered(target, noisy(truth, draw, noise), draw.off(truth, 8, 4e-3), options);
      EXPECT_EQ(kinds(fit), std::pair(1, 1));
      for (const UnobservableMotion& motion : fit.free) {
        EXPECT_GT(std::abs(motion.axis.z()), 0.999) << inWords(motion);
        EXPECT_LT(motion.axis_point.head<2>().norm(), 1e-3);
      }
    }
    { // a body without unobservable motions
      const SurfaceTarget target(test::lumpy(), 0);
      const auto truth = draw.pathOn(target, 300);
      EXPECT_TRUE(registered(target, noisy(truth, draw, noise), draw.off(truth, 10, 5e-3), options)
                      .free.empty());
    }
  }
}

TEST(Registration, LeavesUnobservableMotionsUnchanged) {
  const SurfaceTarget target(sheet(0.4, 0.4, 20), 0);
  Draw draw(6);
  std::vector<Vec3> path;
  for (int i = 0; i < 300; ++i)
    path.emplace_back(0.04 * std::sin(0.02 * i), 0.03 * std::sin(0.05 * i), 0);
  const Pose start = draw.off(path, 10, 5e-3);
  const Registration fit = registered(target, noisy(path, draw, 3e-4), start);
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();
  for (const Vec3& p : path) {
    before += start * p / 300;
    after += fit.mesh_from_path * p / 300;
  }
  EXPECT_LT((after - before).head<2>().norm(), 0.2 * std::abs((after - before).z()) + 2e-4);
}

TEST(Registration, PlanarPathIsFlaggedByTheLiteralLoopAndFitted) {
  const SurfaceTarget target(sheet(0.2, 0.2, 20), 0);
  std::vector<Vec3> path;
  for (int i = 0; i < 100; ++i)
    path.emplace_back(0.04 * std::sin(0.06 * i), 0.03 * std::sin(0.15 * i), 0);
  Pose start = Pose::Identity();
  start.translation().z() = 3e-3;
  IcpOptions literal;
  literal.affine = true;
  const IcpResult fit = iteratedClosestPoints(target, path, start, literal);
  EXPECT_TRUE(fit.fell_back);
  EXPECT_TRUE(fit.mesh_from_path.matrix().allFinite());
  EXPECT_LT(fit.mean_distance, 1e-9);
}

TEST(Registration, ProbeRadiusIsAnOffset) {
  Draw draw(7);
  const double radius = 1.5e-3;
  const SurfaceTarget surface(test::lumpy(), 0), target(test::lumpy(), radius);
  auto truth = draw.pathOn(surface, 300);
  for (Vec3& p : truth) {
    const std::int32_t face = surface.tree().closestPoint(p).surface.face;
    p += radius * faceNormal(surface.mesh(), index(face));
  }
  const Registration fit = registered(target, truth, draw.off(truth, 10, 4e-3));
  EXPECT_LT(missOf(fit.mesh_from_path, truth), 2e-5); // the normals are those of the facets
  EXPECT_LT(std::abs(fit.mean_distance), 2e-5);
}

TEST(Registration, PressedPathOnABoxIsFreeToSlide) {
  const SurfaceTarget target(box(Vec3(0.2, 0.2, 0.005)), 0, true);
  Draw draw(13);
  std::vector<Vec3> path;
  RegistrationOptions options;
  options.noise = 1e-4;
  for (int i = 0; i < 400; ++i) {
    options.indentations.push_back(3e-4 * (1 + std::sin(0.1 * i)));
    path.push_back(Vec3(0.04 * std::sin(0.02 * i), 0.03 * std::sin(0.05 * i),
                        0.0025 - options.indentations.back()) +
                   draw.normal(options.noise));
  }
  const Registration fit = registered(target, path, draw.off(path, 4, 2e-3), options);
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(fit.free.size(), 3U);
  EXPECT_NEAR(fit.rms, options.noise, 2e-5);
  EXPECT_TRUE(fit.covariance.allFinite());
  options.indentations.pop_back();
  EXPECT_THROW(registered(target, path, Pose::Identity(), options), std::invalid_argument);
}

TEST(Registration, ErrorBarsMatchTheErrors) {
  const SurfaceTarget target(test::lumpy(), 0);
  Draw draw(8);
  const auto truth = draw.pathOn(target, 400);
  double squares = 0;
  const int rounds = 200;
  for (int round = 0; round < rounds; ++round) {
    RegistrationOptions options;
    options.noise = 1e-4;
    const Registration fit =
        registered(target, noisy(truth, draw, 1e-4), draw.off(truth, 3, 1e-3), options);
    const Eigen::AngleAxisd turn(fit.mesh_from_path.linear());
    Vec6 error;
    error << turn.angle() * turn.axis(), fit.mesh_from_path * fit.middle - fit.middle;
    squares += error.dot(SymmetricSolver(fit.covariance).solve(error)) / rounds;
  }
  std::printf("mean squared error in deviations: %.2f of 6\n", squares);
  EXPECT_NEAR(squares, 6, 1); // two deviations are .49 for 200 draws
}

TEST(Registration, IgnoresOrderRepetitionAndGapsOfThePath) {
  const SurfaceTarget target(test::lumpy(20), 0);
  Draw draw(9);
  const auto truth = draw.pathOn(target, 200);
  const Pose start = draw.off(truth, 5, 3e-3);
  const Pose whole = registered(target, truth, start).mesh_from_path;
  // T-A10e: neither order nor repetition nor a gap matters.
  std::vector<Vec3> shuffled = truth;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));
  shuffled.insert(shuffled.end(), truth.begin(), truth.end());
  shuffled.emplace_back(std::nan(""), 0, 0);
  EXPECT_LT(missOf(registered(target, shuffled, start).mesh_from_path * whole.inverse(), truth),
            1e-7);
  for (const std::size_t n : {1U, 2U, 3U}) {
    const std::vector<Vec3> few(truth.begin(), truth.begin() + static_cast<std::ptrdiff_t>(n));
    const Registration fit = registered(target, few, start);
    EXPECT_TRUE(fit.mesh_from_path.matrix().allFinite());
    EXPECT_GE(fit.free.size(), 6 - n);
    EXPECT_TRUE(fit.covariance.allFinite());
  }
  std::vector<Vec3> line;
  for (int i = 0; i < 50; ++i) line.emplace_back(1e-4 * i, 0, 0);
  const SurfaceTarget plane(sheet(0.2, 0.2, 4), 0);
  EXPECT_EQ(registered(plane, line, Pose::Identity()).free.size(), 4U);
  EXPECT_THROW(registered(target, {}, start), std::invalid_argument);
  EXPECT_THROW(registered(target, {Vec3::Constant(std::nan(""))}, start), std::invalid_argument);

  // Far from the origin only the last digits of the coordinates are lost.
  TriangleMesh far_mesh = test::lumpy(20);
  const Vec3 away(1e3, -2e3, 5e2);
  for (Vec3& p : far_mesh.positions) p += away;
  const SurfaceTarget far_target(far_mesh, 0);
  Pose there = Pose::Identity();
  there.translation() = away;
  const Pose fit = registered(far_target, truth, there * start).mesh_from_path;
  EXPECT_LT(missOf(there.inverse() * fit, truth), 1e-8);
}

// A brute-force mean over drawn errors of the pose.
TEST(PathDeviation, IsTheRmsDisplacementOfThePoints) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  Registration found;
  std::vector<Vec3> points;
  for (int i = 0; i < 60; ++i) {
    points.emplace_back(0.03 * std::cos(0.1 * i), 0.01 * std::sin(0.1 * i), 0.004 * std::sin(i));
    found.middle += points.back() / 60;
  }
  for (const Vec3& p : points) {
    found.residuals.emplace_back();
    found.residuals.back().at = p;
  }
  Mat6 root = Mat6::Zero();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) root(i, j) = (i < 3 ? 0.02 : 2e-4) * normal(random);
  found.covariance = root * root.transpose();
  double squares = 0;
  constexpr int kDraws = 20000;
  for (int draw = 0; draw < kDraws; ++draw) {
    Vec6 unit;
    for (int k = 0; k < 6; ++k) unit[k] = normal(random);
    const Vec6 error = root * unit;
    for (const Vec3& p : points)
      squares += (error.head<3>().cross(p - found.middle) + error.tail<3>()).squaredNorm() / 60;
  }
  const double truth = std::sqrt(squares / kDraws);
  EXPECT_NEAR(pathDeviation(found), truth, 0.02 * truth);
}

} // namespace
} // namespace patina
