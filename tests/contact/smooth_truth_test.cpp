// On surfaces without faces, where the contact point has a closed form, the error of the force
// falls with the voxel. With a mesh the facets would limit it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/studies/contact/contact_trials.h"
#include "app/studies/contact/scenes.h"
#include "core/percentiles.h"
#include "support/longer.h"

namespace patina::test {
namespace {

// `spine` returns the nearest point of the line or point that the surface surrounds at `radius`.
struct Round {
  std::string name;
  double radius;
  double max_error; // [N], p99 at 150 voxels
  double min_order; // fitted order of p99
  std::function<Vec3(const Vec3&)> spine;

  Vec3 out(const Vec3& p) const { return (p - spine(p)).normalized(); }
  Vec3 on(const Vec3& p, double iso) const { return spine(p) + (radius + iso) * out(p); }
};

// The shapes are not aligned with the grid.
const Vec3 kAlong = Vec3(3, 1, 2).normalized();

std::vector<Round> rounds() {
  return {{"ball", 0.03, 4e-4, 0.9, [](const Vec3&) { return Vec3(Vec3::Zero()); }},
          {"limb", 0.004, 0.03, 0.9,
           [](const Vec3& p) { return Vec3(std::clamp(p.dot(kAlong), -0.04, 0.04) * kAlong); }},
          {"torus", 0.012, 5e-3, 0.9, [](const Vec3& p) {
             const Vec3 flat = p - p.dot(kAlong) * kAlong;
             return Vec3(0.032 * flat.normalized());
           }}};
}

std::shared_ptr<const SurfaceField> fieldOf(const Round& round, double iso, int resolution) {
  FieldGrid grid;
  grid.voxel = 0.1 / resolution;
  grid.origin = Vec3(-0.0531, -0.0527, -0.0533);
  const int nodes = static_cast<int>(0.106 / grid.voxel) + 1;
  grid.nodes = {nodes, nodes, nodes};
  return withSamples(std::make_shared<const SurfaceField>(
      sampleFunction([&](const Vec3& p) { return (p - round.spine(p)).norm() - round.radius; },
                     grid, 4 + iso / grid.voxel)));
}

// Strokes at 10 to 500 mm/s, pressed to 3 N, to three quarters of the radius, or to where c would
// have to run (P04), in and out of contact. [N], |F - K (c - x)| with the c of the closed form.
std::vector<double> errorsOn(const Round& round, double iso, int resolution, long contacts) {
  const auto field = fieldOf(round, iso, resolution);
  const auto snapshot = contactSnapshot(field, iso, "");
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0, 1);
  std::normal_distribution<double> normal;
  std::vector<double> errors;
  long snaps = 0;
  while (std::cmp_less(errors.size(), contacts)) {
    ContactMemory memory;
    Vec3 c = round.on(0.03 * Vec3(normal(random), normal(random), normal(random)), iso);
    Vec3 way(normal(random), normal(random), normal(random));
    const double step = 1e-5 * std::pow(50, any(random)), pace = 0.002 + 0.02 * any(random);
    // Limits the step so that c need not run: P04 moves it by itself at kOwnSpeed.
    const double whole = round.radius + iso,
                 most = std::min({0.006, 0.75 * whole, 0.8 * kOwnSpeed * kTick / step * whole});
    for (int i = 0; i < 300; ++i) {
      const Vec3 n = round.out(c);
      way = (way - way.dot(n) * n).normalized();
      c = round.on(c + step * way, iso);
      const double depth = most * std::sin(pace * i - 0.1);
      const Vec3 out = round.out(c), tip = c - depth * out;
      const Contact contact = tick(*snapshot, memory, tip, kTick);
      EXPECT_FALSE(contact.fault) << round.name;
      if (depth < 0.5 * field->grid.voxel) continue;
      snaps += contact.snap;
      errors.push_back((contact.force - kTestStiffness * depth * out).norm());
    }
  }
  EXPECT_LE(200 * snaps, contacts) << round.name; // 14 of 4000 at most
  return errors;
}

TEST(SmoothSurface, ErrorOfTheForceFallsWithTheVoxel) {
  for (const Round& round : rounds())
    for (const double iso : {0.0, 1e-3}) {
      std::vector<double> p99;
      for (const int resolution : {75, 150, 300}) {
        const Percentiles error = percentiles(errorsOn(round, iso, resolution, longer(4000)));
        std::printf("%-6s %.0f mm, %3d: p50 %.5f p99 %.5f p99.9 %.5f N\n", round.name.c_str(),
                    1e3 * iso, resolution, error.p50, error.p99, error.p999);
        p99.push_back(error.p99);
      }
      EXPECT_GE(std::log2(p99[0] / p99[2]) / 2, round.min_order) << round.name << ' ' << iso;
      EXPECT_LE(p99[1], round.max_error) << round.name << ' ' << iso;
    }
}

} // namespace
} // namespace patina::test
