#include "session/open/stage_cost.h"

#include <algorithm>
#include <chrono>

namespace patina {

namespace {

using Clock = std::chrono::steady_clock;

double nsBetween(Clock::time_point begin, Clock::time_point end) {
  return std::chrono::duration<double, std::nano>(end - begin).count();
}

constexpr int kStrokes = 40;
constexpr int kTicks = 60;
constexpr double kDt = 0.001; // [s]

// Tip that slides along a face from two voxels outside to one inside.
Vec3 strokeTip(const Vec3& centre, const Vec3& normal, double radius, double voxel, int tick) {
  const double fraction = static_cast<double>(tick) / (kTicks - 1);
  const double height = radius + voxel * std::max(2.0 - 6.0 * fraction, -1.0);
  return centre + height * normal + 4.0 * voxel * fraction * normal.unitOrthogonal();
}

} // namespace

double timerNs() {
  double best = 1e9;
  for (int batch = 0; batch < 20; ++batch) {
    constexpr int kReads = 200;
    const Clock::time_point begin = Clock::now();
    Clock::time_point end = begin;
    for (int i = 0; i < kReads; ++i) end = Clock::now();
    best = std::min(best, nsBetween(begin, end) / kReads);
  }
  return best;
}

std::vector<double> stageNs(const CompiledScene& compiled) {
  const HapticSnapshot& snapshot = *compiled.snapshot;
  const TriangleMesh& mesh = *compiled.mesh;
  const double voxel = compiled.built.field->grid.voxel;
  const double radius = compiled.scene.haptics.tip_radius.value_or(0.0);
  const double timer = timerNs();
  std::vector<std::vector<double>> times(snapshot.stages.size());
  const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kStrokes);
  for (std::size_t face = 0; face < mesh.triangles.size(); face += stride) {
    const Vec3 normal = faceNormal(mesh, face);
    if (!normal.allFinite() || normal.isZero(0.0)) continue;
    const Vec3 centre = (mesh.corner(face, 0) + mesh.corner(face, 1) + mesh.corner(face, 2)) / 3.0;
    ContactMemory memory;
    for (int i = 0; i < kTicks; ++i) {
      const Vec3 tip = strokeTip(centre, normal, radius, voxel, i);
      // The stages are timed on a copy of the memory; tick() updates the original.
      ContactMemory trial = memory;
      Contact contact = beginTick(snapshot, memory, tip, kDt);
      for (std::size_t s = 0; s < snapshot.stages.size(); ++s) {
        const Clock::time_point begin = Clock::now();
        snapshot.stages[s]->apply(contact, trial);
        const Clock::time_point end = Clock::now();
        if (contact.touching) times[s].push_back(nsBetween(begin, end));
      }
      (void)tick(snapshot, memory, tip, kDt);
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& list : times) {
    if (list.empty()) {
      medians.push_back(0);
      continue;
    }
    const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
    std::nth_element(list.begin(), middle, list.end());
    medians.push_back(std::max(0.0, *middle - timer));
  }
  return medians;
}

} // namespace patina
