// What moves of the contact point give is forgotten over 100 voxels of way (P11): on any length of
// it the hand gains no more than that allows.
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "app/studies/contact/scenes.h"
#include "geometry/mesh/shapes.h"

namespace patina::test {
namespace {

constexpr double kMostDrive = 8e-5; // voxel^2 per voxel of way, over the stiffness

// Ten times round a ball at one depth, over faces wider and narrower than a voxel.
TEST(LongRounds, GiveNoMoreThanIsForgotten) {
  for (const int split : {16, 48, 100})
    for (const double depth : {1e-3, 3e-3, 6e-3}) {
      const double radius = 0.03;
      const auto field = contactField({"ball", {icosphere(radius, split)}}, 0, 150);
      const auto snapshot = contactSnapshot(field, 0, "");
      const Vec3 u = Vec3(3, 1, -2).normalized(), v = u.cross(Vec3(0.3, -0.2, 1)).normalized();
      for (const double step : {2e-5, 1e-4}) { // [m] of the tip a tick
        ContactMemory memory;
        for (double r = radius + 1e-3; r > radius - depth; r -= 1e-4)
          tick(*snapshot, memory, r * u, 1e-3);
        const double at = radius - depth, turn = step / at;
        Contact last = tick(*snapshot, memory, at * u, 1e-3);
        double given = 0, way = 0;
        const long ticks = std::lround(10 * 2 * std::numbers::pi / turn);
        const Contact begin = last;
        for (long i = 1; i <= ticks; ++i) {
          const double angle = turn * static_cast<double>(i);
          const Vec3 tip = at * (std::cos(angle) * u + std::sin(angle) * v);
          const Contact now = tick(*snapshot, memory, tip, 1e-3);
          ASSERT_TRUE(now.touching);
          given += 0.5 * (now.force + last.force).dot(now.tip - last.tip);
          way += (now.candidate - last.candidate).norm();
          last = now;
        }
        // What is held in the spring is not given.
        const double held =
            0.5 * kJudgeStiffness * (begin.depth * begin.depth - last.depth * last.depth);
        const double most = kMostDrive * kJudgeStiffness * field->grid.voxel * way;
        std::printf("faces %d, %.0f mm deep, %.2f mm a tick: %.4f mJ in %.2f m, at most %.4f\n",
                    20 * split * split, 1e3 * depth, 1e3 * step, 1e3 * (given - held), way,
                    1e3 * most);
        EXPECT_LE(given - held, most) << split << ' ' << depth << ' ' << step;
      }
    }
}

} // namespace
} // namespace patina::test
