#include "acquisition/registration/register_path.h"

#include <cstdio>
#include <numeric>

#include <gtest/gtest.h>

#include "acquisition/registration/closest_point_loop.h"
#include "acquisition/registration_shapes.h"
#include "core/decompose.h"

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

TEST(Registration, WithoutNoiseThePathLandsWhereItWas) {
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

// Ten seconds of standing on a ridge say no more of where the path lies than a second.
TEST(Registration, StandingCountsOnceWherePlacesDo) {
  const SurfaceTarget target(test::lumpy(), 0);
  Draw draw(7);
  auto path = draw.pathOn(target, 300);
  const auto truth = path;
  const Miss under = target.miss(truth[40]);
  const Vec3 ridge = truth[40] + 0.3e-3 * faceNormal(target.mesh(), index(under.foot.face));
  for (int i = 0; i < 5000; ++i) path.push_back(ridge);
  RegistrationOptions options;
  options.robust = false;
  const double each =
      missOf(registered(target, path, Pose::Identity(), options).mesh_from_path, truth);
  options.place = 0.1e-3;
  const Registration found = registered(target, path, Pose::Identity(), options);
  const double once = missOf(found.mesh_from_path, truth);
  std::printf("each sample %.4f mm, each place %.4f mm\n", 1e3 * each, 1e3 * once);
  EXPECT_LT(once, 0.1 * each);
  ASSERT_EQ(found.misses.size(), path.size());
  EXPECT_EQ(found.counts.size(), path.size());
  EXPECT_NEAR(std::abs(found.misses.back().distance), 0.3e-3, 0.05e-3);
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

  LoopOptions creeping;
  creeping.iterations = 50;
  creeping.still = 0;
  const LoopFit before = closestPointLoop(target, truth, start, creeping);
  EXPECT_GT(missOf(before.mesh_from_path, truth), 1e-4);
  creeping.iterations = 51;
  const LoopFit after = closestPointLoop(target, truth, start, creeping);
  EXPECT_GT(after.mean_distance / before.mean_distance, 0.95); // which looks like the end
  EXPECT_GT(after.last_shift + 0.03 * after.last_turn, 1e-6);  // and is not
}

// T-A10a
TEST(Registration, TheLoopsMeanSquareNeverGrows) {
  const SurfaceTarget target(test::lumpy(12), 0);
  Draw draw(2);
  for (int round = 0; round < 1000; ++round) {
    const auto path = noisy(draw.pathOn(target, 12), draw, 5e-4);
    const Pose start = draw.off(path, draw.uniform(0, 60), draw.uniform(0, 0.03));
    LoopOptions one;
    one.iterations = 1;
    LoopFit fit = closestPointLoop(target, path, start, one);
    for (int step = 0; step < 8; ++step) {
      const LoopFit next = closestPointLoop(target, path, fit.mesh_from_path, one);
      EXPECT_LE(next.mean_square, fit.mean_square * (1 + 1e-12));
      fit = next;
    }
  }
}

// T-A10d
TEST(Registration, FindsItsPlaceFromFarAway) {
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

TEST(Registration, AFifthOfThePointsMayBeElsewhere) {
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
          taken += fit.counts[i];
        }
      EXPECT_LE(taken, far_ones / 20);
    }
    std::printf("%g degrees: %d of 40\n", degrees, found);
    EXPECT_GE(found, 39);
  }
}

// T-A10c
TEST(Registration, SaysWhatTheSurfaceDoesNotSee) {
  const auto kinds = [](const Registration& fit) {
    std::pair<int, int> count{0, 0}; // slides, turns
    for (const FreeMotion& motion : fit.free)
      ++(motion.kind == FreeMotion::Kind::slide ? count.first : count.second);
    return count;
  };
  for (const double noise : {0.0, 3e-4}) {
    Draw draw(5);
    RegistrationOptions options;
    options.noise = noise;
    { // a plane: two slides and a turn about its normal
      const SurfaceTarget target(sheet(0.2, 0.2, 20), 0);
      std::vector<Vec3> path;
      for (int i = 0; i < 300; ++i)
        path.emplace_back(0.04 * std::sin(0.02 * i), 0.03 * std::sin(0.05 * i), 0);
      const Pose start = draw.off(path, 10, 5e-3);
      const Registration fit = registered(target, noisy(path, draw, noise), start, options);
      EXPECT_EQ(kinds(fit), std::pair(2, 1));
      for (const FreeMotion& motion : fit.free) {
        const double up = std::abs(motion.axis.z());
        EXPECT_NEAR(up, motion.kind == FreeMotion::Kind::turn ? 1 : 0, 0.02);
      }
    }
    { // a sphere: three turns about its centre
      const SurfaceTarget target(icosphere(0.04, 60), 0);
      const auto truth = draw.pathOn(target, 300);
      const Registration fit =
          registered(target, noisy(truth, draw, noise), draw.off(truth, 15, 0.01), options);
      EXPECT_EQ(kinds(fit), std::pair(0, 3));
      for (const FreeMotion& motion : fit.free) {
        EXPECT_LT(motion.through.cross(motion.axis).norm(), 1e-3) << inWords(motion);
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
      for (const FreeMotion& motion : fit.free) {
        EXPECT_GT(std::abs(motion.axis.z()), 0.999) << inWords(motion);
        EXPECT_LT(motion.through.head<2>().norm(), 1e-3);
      }
    }
    { // and of a body that has none, nothing
      const SurfaceTarget target(test::lumpy(), 0);
      const auto truth = draw.pathOn(target, 300);
      EXPECT_TRUE(registered(target, noisy(truth, draw, noise), draw.off(truth, 10, 5e-3), options)
                      .free.empty());
    }
  }
}

TEST(Registration, WhatIsFreeIsLeftWhereItWas) {
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

TEST(Registration, APathInAPlaneIsFlaggedByTheLiteralLoopAndFitted) {
  const SurfaceTarget target(sheet(0.2, 0.2, 20), 0);
  std::vector<Vec3> path;
  for (int i = 0; i < 100; ++i)
    path.emplace_back(0.04 * std::sin(0.06 * i), 0.03 * std::sin(0.15 * i), 0);
  Pose start = Pose::Identity();
  start.translation().z() = 3e-3;
  LoopOptions literal;
  literal.literal = true;
  const LoopFit fit = closestPointLoop(target, path, start, literal);
  EXPECT_TRUE(fit.fell_back);
  EXPECT_TRUE(fit.mesh_from_path.matrix().allFinite());
  EXPECT_LT(fit.mean_distance, 1e-9);
}

TEST(Registration, TheProbesRadiusIsAnOffset) {
  Draw draw(7);
  const double radius = 1.5e-3;
  const SurfaceTarget surface(test::lumpy(), 0), target(test::lumpy(), radius);
  auto truth = draw.pathOn(surface, 300);
  for (Vec3& p : truth) {
    const std::int32_t face = surface.tree().closestPoint(p).surface.face;
    p += radius * faceNormal(surface.mesh(), index(face));
  }
  const Registration fit = registered(target, truth, draw.off(truth, 10, 4e-3));
  EXPECT_LT(missOf(fit.mesh_from_path, truth), 2e-5); // facets: the normals are theirs
  EXPECT_LT(std::abs(fit.mean_distance), 2e-5);
}

TEST(Registration, APressedPathOnAPlateOfTwelveTrianglesIsFreeToSlide) {
  const SurfaceTarget target(box(Vec3(0.2, 0.2, 0.005)), 0, true);
  Draw draw(13);
  std::vector<Vec3> path;
  RegistrationOptions options;
  options.noise = 1e-4;
  for (int i = 0; i < 400; ++i) {
    options.pressed.push_back(3e-4 * (1 + std::sin(0.1 * i)));
    path.push_back(Vec3(0.04 * std::sin(0.02 * i), 0.03 * std::sin(0.05 * i),
                        0.0025 - options.pressed.back()) +
                   draw.normal(options.noise));
  }
  const Registration fit = registered(target, path, draw.off(path, 4, 2e-3), options);
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(fit.free.size(), 3U);
  EXPECT_NEAR(fit.rms, options.noise, 2e-5);
  EXPECT_TRUE(fit.covariance.allFinite());
  options.pressed.pop_back();
  EXPECT_THROW(registered(target, path, Pose::Identity(), options), std::invalid_argument);
}

TEST(Registration, ErrorBarsAreThoseOfTheErrors) {
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
  EXPECT_NEAR(squares, 6, 1); // of 200 draws, two deviations are .49
}

TEST(Registration, OddPathsAreTakenAsTheyAre) {
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

  // Far from the origin nothing is lost but the numbers' own last digits.
  TriangleMesh far_mesh = test::lumpy(20);
  const Vec3 away(1e3, -2e3, 5e2);
  for (Vec3& p : far_mesh.positions) p += away;
  const SurfaceTarget far_target(far_mesh, 0);
  Pose there = Pose::Identity();
  there.translation() = away;
  const Pose fit = registered(far_target, truth, there * start).mesh_from_path;
  EXPECT_LT(missOf(there.inverse() * fit, truth), 1e-8);
}

} // namespace
} // namespace patina
