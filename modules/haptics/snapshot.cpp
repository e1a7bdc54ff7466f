#include "haptics/snapshot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/numbers.h"
#include "haptics/contact_stage.h"
#include "haptics/friction_stage.h"
#include "haptics/limit_stage.h"
#include "haptics/spring_stage.h"

namespace patina {
namespace {

constexpr double kVelocityCutoff = 200; // [Hz]
constexpr double kVelocityTime = 1 / (2 * 3.14159265358979323846 * kVelocityCutoff);
constexpr double kMinVelocityPeriod = 1e-6; // [s]; less measures nothing
constexpr double kMaxVelocity = 1e6;        // [m/s]; beyond it the tip was set, not moved
constexpr double kMinBandBeyondTip = 3;     // voxels

void checkField(const SurfaceField* field, const HapticProperties& haptics) {
  if (!field) throw std::invalid_argument("compileStages: no field");
  if (field->sample.size() != field->blockCount()) {
    throw std::invalid_argument("compileStages: the field has no sample layer");
  }
  const double radius = haptics.tip_radius.value_or(0) / field->grid.voxel;
  if (radius + kMinBandBeyondTip > field->band) {
    throw Error("tip.radius = " + formatLength(*haptics.tip_radius) +
                " does not fit into the band of " + formatNumber(field->band) +
                " voxels; set band to " + formatNumber(std::ceil(radius + kMinBandBeyondTip)) +
                " or more");
  }
}

std::size_t bytesRead(const SurfaceField& field) {
  std::size_t bytes = 0;
  for (const LayerBytes& layer : field.layerBytes()) {
    if (layer.name == "top" || layer.name == "sample" || layer.name == "coarse") {
      bytes += layer.bytes;
    }
  }
  return bytes;
}

// v_max of the jump fault: the hand's, scaled up with a model larger than its workspace.
double maxSpeed(const FieldGrid& grid) {
  const int cells = *std::max_element(grid.nodes.begin(), grid.nodes.end()) - 1;
  return kHandSpeed * std::max(1.0, cells * grid.voxel / kHandWorkspace);
}

std::shared_ptr<const HapticSnapshot> compiled(const Scene& scene,
                                               std::shared_ptr<const SurfaceField> field,
                                               const std::optional<Friction>& friction,
                                               const std::optional<double>& damping) {
  const HapticProperties& haptics = scene.haptics;
  checkField(field.get(), haptics);
  auto snapshot = std::make_shared<HapticSnapshot>();
  const auto add = [&](std::unique_ptr<const ForceStage> stage, std::string why,
                       std::size_t bytes = 0) {
    snapshot->why.push_back({std::string(stage->name()), std::move(why), bytes});
    snapshot->stages.push_back(std::move(stage));
  };
  const double radius = haptics.tip_radius.value_or(0);
  add(std::make_unique<ContactStage>(field, scene.sampler, radius),
      haptics.tip_radius ? "tip.radius = " + formatNumber(radius) : "always", bytesRead(*field));
  if (friction) {
    add(std::make_unique<FrictionStage>(field, scene.sampler, radius, *friction),
        "friction.static = " + formatNumber(friction->static_coefficient));
  }
  add(std::make_unique<SpringStage>(haptics.stiffness),
      "stiffness = " + formatNumber(haptics.stiffness));
  if (damping) {
    add(std::make_unique<DampingStage>(*damping), "damping = " + formatNumber(*damping));
  }
  add(std::make_unique<LimitStage>(LimitSpec{haptics.force_limit, haptics.stiffness,
                                             damping.value_or(0), maxSpeed(field->grid)}),
      "always");
  snapshot->field = std::move(field);
  return snapshot;
}

} // namespace

std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field) {
  std::optional<Friction> friction = scene.haptics.friction;
  if (friction && friction->static_coefficient == 0) friction.reset();
  std::optional<double> damping = scene.haptics.damping;
  if (damping && *damping == 0) damping.reset();
  return compiled(scene, std::move(field), friction, damping);
}

std::shared_ptr<const HapticSnapshot> compileAllStages(const Scene& scene,
                                                       std::shared_ptr<const SurfaceField> field) {
  return compiled(scene, std::move(field), scene.haptics.friction.value_or(Friction{}),
                  scene.haptics.damping.value_or(0.0));
}

Contact tick(const HapticSnapshot& snapshot, ContactMemory& memory, const Vec3& tip,
             double dt) noexcept {
  Contact contact;
  contact.tip = tip;
  contact.candidate = tip;
  contact.vcp = tip;
  const double period = dt > 0 && dt < 1e6 ? dt : 0;
  contact.dt = memory.gap + period;
  if (!tip.allFinite()) {
    ++memory.bad_tips;
    memory.gap = contact.dt;
    return contact;
  }
  memory.gap = 0;
  if (memory.has_last_tip && contact.dt >= kMinVelocityPeriod) {
    const Vec3 difference = 1 / contact.dt * (tip - memory.last_tip);
    memory.velocity += contact.dt / (contact.dt + kVelocityTime) * (difference - memory.velocity);
    // Also where it is infinite or NaN, which no filter would ever forget.
    if (!(memory.velocity.squaredNorm() < kMaxVelocity * kMaxVelocity)) memory.velocity.setZero();
  }
  contact.velocity = memory.velocity;
  for (const auto& stage : snapshot.stages) stage->apply(contact, memory);
  memory.last_tip = tip;
  memory.has_last_tip = true;
  return contact;
}

} // namespace patina
