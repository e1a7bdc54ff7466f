// T-ENER (MATH 2.5): work round closed loops in contact, by the trapezium rule on a fine path.
#include <array>
#include <cstdio>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "haptics/contact_fixture.h"

namespace patina {
namespace {

constexpr double kLoopStiffness = 1000, kDepth = 2.5e-3, kLoop = 1.5e-3;
constexpr double kStored = 0.5 * kLoopStiffness * kDepth * kDepth;

const std::vector<Vec3> kAxes = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};

// Work of loops about `centre`, in the planes across each of `axes`, after one lap to settle.
struct Loops {
  double worst = 0;   // the largest |work| [J]
  double created = 0; // largest energy given to the hand [J]
};
Loops worstLoop(const HapticSnapshot& snapshot, const Vec3& centre, const std::vector<Vec3>& axes) {
  Loops loops;
  for (const Vec3& axis : axes) {
    const Vec3 u = axis.unitOrthogonal(), v = axis.normalized().cross(u);
    const int count = 3000;
    ContactMemory memory;
    double work = 0;
    Vec3 last_force = Vec3::Zero(), last_tip = Vec3::Zero();
    // One lap settles the contact: its memory must be the same after each lap.
    for (int i = -count; i <= count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count;
      const Vec3 tip = centre + kLoop * (std::cos(angle) * u + std::sin(angle) * v);
      const Vec3 force = tick(snapshot, memory, tip, 1e-3).force;
      EXPECT_TRUE(force.allFinite());
      if (i > 0) work += 0.5 * (force + last_force).dot(tip - last_tip);
      last_force = force;
      last_tip = tip;
    }
    EXPECT_FALSE(memory.limit.fault);
    loops.worst = std::max(loops.worst, std::abs(work));
    loops.created = std::max(loops.created, work);
  }
  return loops;
}

struct Mode {
  const char* name;
  void (*set)(HapticProperties&);
  double depth; // depth of the loops' centre below the surface [m]; negative is above it
};

constexpr std::array<Mode, 4> kModes = {{
    {"contact", [](HapticProperties&) {}, kDepth},
    {"finite tip", [](HapticProperties& h) { h.tip_radius = 1e-3; }, kDepth - 1e-3},
    {"offset", [](HapticProperties& h) { h.offset = 2e-3; }, kDepth - 2e-3},
    {"magnet",
     [](HapticProperties& h) {
       h.magnet = Magnet{4.2e-3, kLoopStiffness, false};
     },
     -2.2e-3},
}};

struct LoopEnergy {
  double worst = 0, rms = 0; // [J]
};

LoopEnergy onASphere(const Mode& mode, Sampler sampler, int cells) {
  const double R = 0.03;
  // The bands have one thickness in metres for every voxel.
  const double voxel = 2 * R / (cells - 16.0);
  const double band = std::max(8.0, std::ceil(6e-3 / voxel) + 3);
  const int side = 2 * static_cast<int>(std::ceil(R / voxel + band + 1));
  const Field sphere = cubeField([=](const Vec3& p) { return p.norm() - R; }, voxel, side, band);
  Scene scene = sceneOf(kLoopStiffness, sampler);
  mode.set(scene.haptics);
  // Trilinear values have a bump in every cell: the papers' contact point does not follow them.
  if (sampler == Sampler::kim) scene.haptics.contact = HapticProperties::Contact::ray;
  const auto snapshot = compileStages(scene, sphere);
  LoopEnergy energy;
  std::mt19937 random(11);
  const int count = 24;
  for (int i = 0; i < count; ++i) {
    const double loop =
        worstLoop(*snapshot, (R - mode.depth) * randomDirection(random), kAxes).worst;
    energy.worst = std::max(energy.worst, loop);
    energy.rms += loop * loop;
  }
  energy.rms = std::sqrt(energy.rms / count);
  return energy;
}

TEST(ClosedLoopEnergy, IsSmallOnSmoothSurfacesAndFallsWithTheSquareOfTheVoxel) {
  for (const Sampler sampler : {Sampler::kim, Sampler::high}) {
    for (const Mode& mode : kModes) {
      const LoopEnergy coarse = onASphere(mode, sampler, 75);
      const LoopEnergy fine = onASphere(mode, sampler, 150);
      // The voxels decide, not the cells: the band takes 16 of them.
      const double order = std::log(coarse.rms / fine.rms) / std::log((150 - 16) / (75 - 16.0));
      std::printf("%-10s %s: %.2g J at 75, %.2g J at 150, order %.2f\n", mode.name,
                  std::string(name(sampler)).c_str(), coarse.worst, fine.worst, order);
      EXPECT_LE(fine.worst, 3e-6) << mode.name;
      // 2, less the scatter of 24 places; below it is the unfinished part of a tick, at any voxel.
      if (fine.worst > 5e-7) {
        EXPECT_GE(order, 1.9) << mode.name;
      }
    }
  }
}

// The path runs about the edge of a box, `beside` the bisector of its faces, where the contact
// point may pass from one face to the other: that takes energy and never gives any (P11, T-P4).
TEST(ClosedLoopEnergy, IsNeverGivenAboutACrease) {
  const Vec3 half(0.03, 0.025, 0.02);
  const std::vector<Vec3> axes = {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0.3, 0.5, 0.8)};
  for (const int cells : {75, 150}) {
    const double voxel = 0.06 / (cells - 16.0);
    const double band = std::max(8.0, std::ceil(9e-3 / voxel) + 3);
    const int side = 2 * static_cast<int>(std::ceil(0.03 / voxel + band + 1));
    const Field box =
        cubeField([=](const Vec3& p) { return boxDistance(p, half); }, voxel, side, band);
    for (const Mode& mode : kModes) {
      Scene scene = sceneOf(kLoopStiffness);
      mode.set(scene.haptics);
      if (scene.haptics.magnet) continue; // it pulls out of contact
      const auto snapshot = compileStages(scene, box);
      Loops most;
      for (const double along : {-3e-3, 0.37e-3, 2.1e-3})
        for (const double aside : {0.0, 0.3e-3, 0.5e-3, 1.1e-3, 2.3e-3}) {
          const Vec3 centre = Vec3(half.x(), half.y(), along) - mode.depth * Vec3(1, 1, 0) +
                              aside * Vec3(1, -1, 0.3);
          const Loops loops = worstLoop(*snapshot, centre, axes);
          most.worst = std::max(most.worst, loops.worst);
          most.created = std::max(most.created, loops.created);
        }
      std::printf("%-10s crease at %d: %.2g J given, %.2g J taken at most, of %.2g J stored\n",
                  mode.name, cells, most.created, most.worst, kStored);
      EXPECT_LE(most.created, 5e-6) << mode.name << ' ' << cells;
      EXPECT_LE(most.worst, 4 * kStored) << mode.name << ' ' << cells;
    }
  }
}

} // namespace
} // namespace patina
