// Contact at the boundary of a one-sided open surface: over it, past it, and from behind. The
// surface is the front of a thickened sheet and renders like one.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "app/studies/contact/scenes.h"
#include "contact/course_limits.h"
#include "contact/ways.h"
#include "geometry/mesh/shapes.h"
#include "support/changed_mesh.h"
#include "support/mesh_defects.h"

namespace patina::test {
namespace {

constexpr double kHalf = 0.05;    // [m], of a sheet's side
constexpr double kPressed = 3e-3; // [m]

struct Plate {
  std::string name;
  TriangleMesh mesh; // its front
  double iso;        // [m]
  std::shared_ptr<const HapticSnapshot> snapshot;

  Plate(const std::string& shape, const TriangleMesh& front, double tip)
      : name(shape + (tip > 0 ? ", a tip" : ", a point")), mesh(front), iso(tip),
        snapshot(contactSnapshot(contactField({shape, {front}}, tip, 150), tip, "")) {}

  double thickness() const { return snapshot->field->band * snapshot->field->grid.voxel; }

  struct Run {
    double excess = 0; // [N], of |dF| beyond 2 K |dx| + K v_s dt
    double given = 0;  // [J], the largest energy gained by the hand between free states
    int faults = 0;
    double most = 0, last = 0; // [N], |F|
  };
  Run along(const std::vector<Vec3>& corners, double speed) const {
    Run run;
    ContactMemory memory;
    Contact before;
    double work = 0;
    bool began = false;
    for (const Vec3& tip : way(corners, speed)) {
      const Contact now = tick(*snapshot, memory, tip, kTick);
      if (began) {
        const double step = (tip - before.tip).norm();
        run.excess = std::max(run.excess, (now.force - before.force).norm() -
                                              kTestStiffness * (2 * step + kOwnSpeed * kTick));
        work = before.touching || now.touching
                   ? work + 0.5 * (now.force + before.force).dot(tip - before.tip)
                   : 0;
        if (!now.touching) run.given = std::max(run.given, work);
      }
      began = true;
      run.faults += now.fault || !now.force.allFinite();
      run.most = std::max(run.most, now.force.norm());
      run.last = now.force.norm();
      before = now;
    }
    return run;
  }
};

TriangleMesh flat() {
  return sheet(2 * kHalf, 2 * kHalf, 4);
}
// The solid whose upper face is flat().
TriangleMesh solidUnder(double thickness) {
  return moved(box(Vec3(2 * kHalf, 2 * kHalf, thickness)), Vec3(0, 0, -0.5 * thickness));
}

template <typename Height> TriangleMesh hills(int cells, const Height& height) {
  TriangleMesh mesh = sheet(2 * kHalf, 2 * kHalf, cells);
  for (Vec3& p : mesh.positions) p.z() = height(p.x(), p.y());
  return mesh;
}
template <typename Outside> TriangleMesh without(TriangleMesh mesh, const Outside& outside) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    Vec3 centre = Vec3::Zero();
    for (const std::int32_t v : t) centre += mesh.positions[static_cast<std::size_t>(v)] / 3;
    return outside(centre);
  });
  return mesh;
}

struct Shape {
  std::string name;
  TriangleMesh mesh;
};
std::vector<Shape> shapes() {
  const TriangleMesh terrain = hills(
      80, [](double x, double y) { return 4e-3 * std::sin(90 * x + 0.4) * std::cos(80 * y); });
  return {{"sheet", flat()},
          {"tilted sheet", tilted(flat())},
          {"terrain", terrain},
          {"terrain with holes", withHoles(terrain, 6, 2e-3, 4)},
          {"disc", without(hills(80, [](double, double) { return 0.0; }),
                           [](const Vec3& p) { return p.norm() > kHalf; })},
          {"saddle", hills(40, [](double x, double y) { return 8 * (x * x - y * y); })},
          {"waves", hills(100, [](double x, double) { return 4e-3 * std::sin(400 * x); })},
          {"ridge", hills(50, [](double x, double) { return 0.02 - 3 * std::abs(x); })},
          {"valley", hills(50, [](double x, double) { return 3 * std::abs(x); })},
          {"bowl", without(icosphere(kHalf, 20), [](const Vec3& p) { return p.z() > -0.01; })},
          {"bowl upside down",
           inverted(without(icosphere(kHalf, 20), [](const Vec3& p) { return p.z() > -0.01; }))},
          {"triangle",
           {{Vec3(-0.03, -0.02, 0), Vec3(0.05, -0.015, 0), Vec3(0, 0.04, 0)}, {{0, 1, 2}}, {}}},
          {"sheets 1 mm apart", joined(flat(), moved(flat(), Vec3(1e-4, 0, 1e-3)))},
          {"sheets 4 mm apart", joined(flat(), moved(flat(), Vec3(0.02, 0.01, 4e-3)))},
          {"sheets 8 mm apart", joined(flat(), moved(flat(), Vec3(0.02, 0.01, 8e-3)))}};
}

TEST(OpenRim, MatchesTheThickenedSheet) {
  TrialReport all;
  for (const double iso : {0.0, 1e-3, 2e-3})
    for (const bool turned : {false, true}) {
      const Plate plate("sheet", turned ? tilted(flat()) : flat(), iso);
      const TriangleMesh solid = solidUnder(plate.thickness());
      const ExactSurface surface({turned ? tilted(solid) : solid});
      const TrialReport report =
          runTrials(methodOf(*plate.snapshot), surface, iso, longer(10000), 5);
      const Percentiles error = percentiles(report.error);
      const std::string what = plate.name + (turned ? ", turned" : "");
      std::printf("%-24s %ld ticks in contact, %ld lost, %ld pulls, step %.3f N, error p50 %.4f "
                  "p99 %.3f p99.9 %.3f N\n",
                  what.c_str(), report.contacts, report.lost, report.pulls, report.worst_excess,
                  error.p50, error.p99, error.p999);
      expectFaultless(report, what);
      all.add(report);
    }
  expectExact(all, "plates");
}

TEST(OpenRim, ReleasesATipThatSlipsOff) {
  for (const double iso : {0.0, 1e-3, 2e-3}) {
    const Plate plate("sheet", flat(), iso);
    for (const double past : {1e-3, 2e-3, 8e-3})
      for (const double speed : {0.01, 0.05, 0.5})
        for (const double deep : {1.2e-3, kPressed, 5e-3}) {
          const double z = iso - deep, x = kHalf + iso + past;
          std::vector<Vec3> corners = {{0.04, 1e-3, 8e-3}, {0.04, 1e-3, z}, {kHalf - 6e-3, 0, z}};
          EXPECT_NEAR(plate.along(corners, speed).last, kTestStiffness * deep, 0.05) << plate.name;
          corners.insert(corners.end(), {Vec3(x, 0, z), Vec3(x, 0, -0.04), Vec3(0.03, 0, -0.04)});
          const Plate::Run run = plate.along(corners, speed);
          EXPECT_EQ(run.last, 0) << plate.name << ' ' << past << ' ' << speed << ' ' << deep;
          EXPECT_EQ(run.faults, 0) << plate.name;
          EXPECT_LE(run.excess, kWorstStep) << plate.name;
        }
  }
}

// The back lies at the end of the band and holds like any surface.
TEST(OpenRim, ContactFromBehindHasNoForceStep) {
  for (const double iso : {0.0, 1e-3})
    for (const double speed : {0.01, 0.05, 0.5})
      for (const Vec3& aside : {Vec3(0, 0, 0), Vec3(0.02, -0.03, 0), Vec3(0.04, 0.01, 0)}) {
        const Plate plate("sheet", flat(), iso);
        const double back = -plate.thickness() - iso;
        const Vec3 from = aside + Vec3(0.002, 0, back - 0.02), to = aside + Vec3(0, 0, back + 2e-3);
        const Plate::Run in = plate.along({from, to}, speed);
        EXPECT_NEAR(in.last, kTestStiffness * 2e-3, 0.05) << plate.name;
        const Plate::Run run = plate.along({from, to, from}, speed);
        EXPECT_EQ(run.last, 0) << plate.name;
        EXPECT_EQ(run.faults, 0) << plate.name;
        EXPECT_LE(run.excess, kWorstStep) << plate.name;
      }
}

// Polylines around the boundaries.
TEST(OpenRim, HasNoForceStepsAndGeneratesNoEnergyOnAnyPath) {
  for (const Shape& shape : shapes())
    for (const double iso : {0.0, 1e-3}) {
      const Plate plate(shape.name, shape.mesh, iso);
      std::mt19937 random(7);
      std::uniform_real_distribution<double> unit(-1, 1);
      const auto rim = rims(shape.mesh);
      const Vec3 far = 0.12 * Vec3(1, 0.2, 0.3);
      Plate::Run worst;
      int held = 0;
      for (int i = 0; i < longer(40); ++i) {
        const auto& [a, b] =
            rim[std::uniform_int_distribution<std::size_t>(0, rim.size() - 1)(random)];
        std::vector<Vec3> corners = {far};
        const double t = 0.5 * (1 + unit(random));
        for (int k = 0; k < 8; ++k)
          corners.push_back(a + t * (b - a) +
                            7e-3 * Vec3(unit(random), unit(random), unit(random)));
        corners.push_back(far);
        // The trapezium rule needs steps of 10 um to measure work.
        const bool slow = i % 4 == 0;
        const Plate::Run run = plate.along(corners, slow ? 0.01 : 0.02 + 0.24 * (unit(random) + 1));
        EXPECT_EQ(run.faults, 0) << plate.name;
        held += run.most > 0;
        worst.excess = std::max(worst.excess, run.excess);
        if (slow) worst.given = std::max(worst.given, run.given);
      }
      std::printf("%-28s %d of %ld held, worst excess %.4f N, most energy given %.3f uJ\n",
                  plate.name.c_str(), held, longer(40), worst.excess, 1e6 * worst.given);
      EXPECT_LE(worst.excess, kWorstStep) << plate.name;
      EXPECT_LE(worst.given, 5e-6) << plate.name;
      EXPECT_GT(held, longer(40) / 2) << plate.name;
    }
}

} // namespace
} // namespace patina::test
