#include "haptics/snapshot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/numbers.h"
#include "haptics/contact_stage.h"
#include "haptics/force_law.h"
#include "haptics/friction_stage.h"
#include "haptics/limit_stage.h"
#include "haptics/magnet_stage.h"
#include "haptics/offset_stage.h"
#include "haptics/potential_stage.h"

namespace patina {
namespace {

constexpr double kMinVelocityPeriod = 1e-6; // [s]; less measures nothing
constexpr double kMaxVelocity = 1e6;        // [m/s]; beyond it the tip was set, not moved

void checkField(const SurfaceField* field, const HapticProperties& haptics) {
  if (!field) throw std::invalid_argument("compileStages: no field");
  if (field->sample.size() != field->blockCount()) {
    throw std::invalid_argument("compileStages: the field has no sample layer");
  }
  const double reach = reachOf(haptics) / field->grid.voxel;
  if (reach + kBandBeyondReach > field->band) {
    std::string what;
    if (haptics.tip_radius) what = "tip.radius = " + formatLength(*haptics.tip_radius);
    const auto with = [&](const char* key, double length) {
      what += (what.empty() ? "" : " with ") + (key + (" = " + formatLength(length)));
    };
    if (haptics.offset) with("offset", *haptics.offset);
    if (haptics.magnet) with("magnet.range", haptics.magnet->range);
    throw Error(what + " does not fit into the band of " + formatNumber(field->band) +
                " voxels; set band to " + formatNumber(std::ceil(reach + kBandBeyondReach)) +
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

std::shared_ptr<const HapticSnapshot> compiled(const Scene& scene, const HapticProperties& haptics,
                                               std::shared_ptr<const SurfaceField> field,
                                               std::span<const FeltObject>) {
  checkField(field.get(), haptics);
  auto snapshot = std::make_shared<HapticSnapshot>();
  const auto add = [&](std::unique_ptr<const ForceStage> stage, std::string why,
                       std::size_t bytes = 0) {
    addStage(*snapshot, std::move(stage), std::move(why), bytes);
  };
  const double radius = haptics.tip_radius.value_or(0);
  const double iso = radius + haptics.offset.value_or(0);
  add(std::make_unique<ContactStage>(field, scene.sampler, iso, haptics.history),
      haptics.tip_radius ? "tip.radius = " + formatNumber(radius) : "always", bytesRead(*field));
  if (haptics.contact == HapticProperties::Contact::potential)
    add(std::make_unique<PotentialStage>(field, scene.sampler, iso), "contact = potential");
  if (haptics.offset) {
    add(std::make_unique<OffsetStage>(field, scene.sampler),
        "offset = " + formatNumber(*haptics.offset));
  }
  if (haptics.friction) {
    add(std::make_unique<FrictionStage>(field, scene.sampler, iso, *haptics.friction),
        "friction.static = " + formatNumber(haptics.friction->static_coefficient));
  }
  const MagnetMaker magnet = [&](const Magnet& spec) {
    return std::make_unique<MagnetStage>(field, scene.sampler, radius, spec);
  };
  addForceLaw(*snapshot, haptics, planStabilisers(haptics, scene.device_model, scene.stabilisers),
              magnet, maxSpeed(field->grid));
  snapshot->field = std::move(field);
  snapshot->base = baseMaterial(haptics);
  return snapshot;
}

} // namespace

double reachOf(const HapticProperties& haptics) {
  return haptics.tip_radius.value_or(0) +
         std::max(haptics.offset.value_or(0), haptics.magnet ? haptics.magnet->range : 0.0);
}

std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field,
                                                    std::span<const FeltObject> objects) {
  HapticProperties needed = scene.haptics;
  if (needed.friction && needed.friction->static_coefficient == 0) needed.friction.reset();
  if (needed.damping == 0.0) needed.damping.reset();
  if (needed.offset == 0.0) needed.offset.reset();
  if (needed.magnet && needed.magnet->range * needed.magnet->strength == 0) needed.magnet.reset();
  if (!needed.damping) needed.damping_cutoff.reset();
  return compiled(scene, needed, std::move(field), objects);
}

std::shared_ptr<const HapticSnapshot> compileAllStages(const Scene& scene,
                                                       std::shared_ptr<const SurfaceField> field,
                                                       std::span<const FeltObject> objects) {
  HapticProperties all = scene.haptics;
  if (!all.friction) all.friction = Friction{};
  if (!all.damping) all.damping = 0;
  if (!all.magnet) all.magnet = Magnet{};
  return compiled(scene, all, std::move(field), objects);
}

Contact tick(const HapticSnapshot& snapshot, ContactMemory& memory, const Vec3& tip,
             double dt) noexcept {
  Contact contact;
  contact.tip = tip;
  contact.candidate = tip;
  contact.vcp = tip;
  contact.surface = tip;
  const double period = dt > 0 && dt < 1e6 ? dt : 0;
  contact.dt = memory.gap + period;
  if (!tip.allFinite()) {
    ++memory.bad_tips;
    memory.gap = contact.dt;
    memory.applied.setZero();
    return contact;
  }
  memory.gap = 0;
  if (memory.has_last_tip && contact.dt >= kMinVelocityPeriod) {
    contact.velocity = 1 / contact.dt * (tip - memory.last_tip);
    // Also where it is infinite or NaN, which no filter would ever forget.
    if (!(contact.velocity.squaredNorm() < kMaxVelocity * kMaxVelocity)) contact.velocity.setZero();
  }
  for (const auto& stage : snapshot.stages) stage->apply(contact, memory);
  memory.last_tip = tip;
  memory.has_last_tip = true;
  memory.applied = contact.force;
  return contact;
}

} // namespace patina
