#include "app/studies/framework/studies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "app/studies/framework/query_timing.h"
#include "app/studies/paint/paint_shapes.h"
#include "session/compile/compile_scene.h"

namespace patina {
namespace {

constexpr double kSide = 0.04, kThickness = 0.01; // [m]
constexpr double kDeep = 2e-3; // extent of the material above and below the top [m]
constexpr double kPeriod = 1e-3;
constexpr double kPi = std::numbers::pi;

Scene slab(int resolution, ForceForm form) {
  Scene scene = slabScene(kSide, kThickness, resolution);
  scene.haptics.force_limit = 100;
  scene.material_form = form;
  return scene;
}

double waved(const Vec3& p) {
  return 600 + 300 * std::sin(2 * kPi * p.x() / 8e-3) * std::cos(2 * kPi * p.y() / 1e-2);
}

// Stiffness from the force on the slab, against the painted function.
WorkPrecisionTable value(const std::vector<double>& voxels, int points, Progress& progress) {
  WorkPrecisionTable table =
      tableOf("Stiffness felt on a painted slab, rms and max; trilinear, order 2", "N/m");
  OrderFit order;
  for (const bool painted : {true, false}) {
    for (const double voxel : voxels) {
      progress.throwIfCancelled();
      Scene scene = slab(80, ForceForm::literal);
      if (painted) layMaterial(scene, kSide, voxel, kDeep, MaterialChannel::stiffness, waved);
      const auto compiled = compile(scene, progress);
      std::mt19937 random(3);
      std::uniform_real_distribution<double> place(-0.3 * kSide, 0.3 * kSide);
      std::vector<Vec3> tips;
      WorkPrecisionRow row;
      row.settings = {{"painted", painted}, {"voxel [mm]", 1e3 * voxel}};
      for (int i = 0; i < points; ++i) {
        tips.emplace_back(place(random), place(random), -1e-3);
        ContactMemory memory;
        const Contact contact = tick(*compiled->snapshot, memory, tips.back(), kPeriod);
        const double stiffness = contact.force.norm() / contact.depth;
        const double truth =
            painted ? waved({tips.back().x(), tips.back().y(), 0}) : scene.haptics.stiffness;
        const double error = std::abs(stiffness - truth);
        row.error += error * error / points;
        row.error_max = std::max(row.error_max, error);
      }
      row.error = std::sqrt(row.error);
      row.ns = nsPerQuery(tips, [&](const Vec3& tip) {
        ContactMemory memory;
        return tick(*compiled->snapshot, memory, tip, kPeriod).depth;
      });
      row.bytes = static_cast<double>(compiled->paint.bytes());
      if (painted) order.add(voxel, row.error);
      table.rows.push_back(std::move(row));
      if (!painted) break; // one row for comparison
    }
  }
  order.into(table, 2);
  return table;
}

// Energy given to the hand [J]: down on the soft side, across, up on the hard one and back above.
double loopWork(const HapticSnapshot& snapshot, double across, double depth) {
  constexpr int kSteps = 4000;
  const Vec3 corners[]{{-across, 0, 1e-3},
                       {-across, 0, -depth},
                       {across, 0, -depth},
                       {across, 0, 1e-3},
                       {-across, 0, 1e-3}};
  ContactMemory memory;
  Vec3 last_tip = corners[0];
  Vec3 last_force = tick(snapshot, memory, last_tip, kPeriod).force;
  double work = 0;
  for (int leg = 0; leg < 4; ++leg) {
    for (int i = 1; i <= kSteps; ++i) {
      const Vec3 tip =
          corners[leg] + (static_cast<double>(i) / kSteps) * (corners[leg + 1] - corners[leg]);
      const Vec3 force = tick(snapshot, memory, tip, kPeriod).force;
      work += 0.5 * (force + last_force).dot(tip - last_tip);
      last_tip = tip;
      last_force = force;
    }
  }
  return work;
}

// T-K22d. The error is the distance from the form's theory: 1/2 (K2 - K1) d^2, or zero.
WorkPrecisionTable energy(const std::vector<double>& voxels, Progress& progress) {
  constexpr double kSoft = 200, kHard = 1000, kDepth = 1.5e-3, kAcross = 8e-3;
  const double given = 0.5 * (kHard - kSoft) * kDepth * kDepth;
  WorkPrecisionTable table = tableOf(
      "Work round a loop over a border of stiffness (T-K22d): literal gives 0.5 (K2 - K1) d^2, "
      "conservative nothing",
      "J");
  for (const ForceForm form : {ForceForm::literal, ForceForm::conservative}) {
    for (const double voxel : voxels) {
      progress.throwIfCancelled();
      Scene scene = slab(80, form);
      layMaterial(scene, kSide, voxel, kDeep, MaterialChannel::stiffness, [&](const Vec3& p) {
        return kSoft + (kHard - kSoft) * (0.5 + 0.5 * std::tanh(p.x() / 2e-3));
      });
      const auto compiled = compile(scene, progress);
      WorkPrecisionRow row;
      const bool literal = form == ForceForm::literal;
      row.settings = {{"form", literal ? "literal" : "conservative"}, {"voxel [mm]", 1e3 * voxel}};
      std::vector<Vec3> tips;
      for (int i = 0; i < 400; ++i) tips.emplace_back(-kAcross + 4e-5 * i, 0, -kDepth);
      const double work = loopWork(*compiled->snapshot, kAcross, kDepth);
      row.error = std::abs(work - (literal ? given : 0));
      row.error_max = row.error;
      row.ns = nsPerQuery(tips, [&](const Vec3& tip) {
        ContactMemory memory;
        return tick(*compiled->snapshot, memory, tip, kPeriod).depth;
      });
      row.bytes = static_cast<double>(compiled->paint.bytes());
      row.more = {{"work [J]", work}, {"of 0.5 (K2 - K1) d^2 [%]", 100 * work / given}};
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> materialStudy(const StudyOptions& options, Progress& progress) {
  const std::vector<double> voxels = options.quick
                                         ? std::vector{1e-3, 0.5e-3}
                                         : std::vector{1.5e-3, 1e-3, 0.7e-3, 0.5e-3, 0.35e-3};
  const int points = options.quick ? 1000 : 5000;
  return tablesOf({{0, "value", [&] { return value(voxels, points, progress); }},
                   {0.5, "closed loops", [&] { return energy(voxels, progress); }}},
                  progress);
}

} // namespace patina
