#include "app/cli/input/simulation_start.h"

#include "core/error.h"
#include "geometry/tree/triangle_tree.h"

namespace patina::cli {

namespace {

constexpr int kNewtonSteps = 20;
constexpr double kLeastGradient = 0.1;

} // namespace

SimulationStart simulationStart(const CompiledScene& compiled) {
  const TriangleMesh& mesh = *compiled.mesh;
  const Box3 box = bounds(mesh);
  const double height = box.sizes().norm();
  const Vec3 above(box.center().x(), box.center().y(), box.max().z() + 0.01 * height);
  const TriangleTree tree(mesh);
  const std::optional<RayHit> hit = tree.firstHit(above, -Vec3::UnitZ(), 2 * height);
  const Vec3 foot = hit ? Vec3(above - hit->t * Vec3::UnitZ()) : tree.closestPoint(above).point;

  const HapticProperties& haptics = compiled.scene.haptics;
  const double iso = haptics.tip_radius.value_or(0) + haptics.offset.value_or(0);
  // A sheet that is felt from both sides has no direction in itself.
  Vec3 p = foot + iso * (above - foot).normalized();
  const FieldSampler sampler(*compiled.built.field, compiled.scene.sampler);
  Vec3 direction = Vec3::Zero();
  for (int i = 0; i < kNewtonSteps; ++i) {
    const GridSample sample = sampler.at(p);
    const double length = sample.gradient.norm();
    if (!(length > kLeastGradient))
      throw Error("there is no direction at the start of the run, below the middle of the top; "
                  "raise --resolution or --band");
    direction = sample.gradient / length;
    p -= (sample.phi - iso) / length * direction;
  }
  return {p, -direction};
}

} // namespace patina::cli
