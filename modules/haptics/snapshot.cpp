#include "haptics/snapshot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/numbers.h"
#include "haptics/force_law.h"
#include "haptics/friction_stage.h"
#include "haptics/lateral_stage.h"
#include "haptics/limit_stage.h"
#include "haptics/magnet_stage.h"
#include "haptics/material_stage.h"
#include "haptics/offset_stage.h"
#include "haptics/proxy_stage.h"
#include "haptics/ray_stage.h"
#include "haptics/relief_stage.h"

namespace patina {
namespace {

constexpr double kMinVelocityPeriod = 1e-6; // [s]; less measures nothing
// Of baked relief; what is steeper is not crossed unseen but for parts thinner than a voxel.
constexpr double kBakedSteepness = 4;
constexpr double kMaxVelocity = 1e6; // [m/s]; beyond it the tip was set, not moved

void checkField(const SurfaceField* field, const HapticProperties& haptics, double relief,
                double roughness) {
  if (!field) throw std::invalid_argument("compileStages: no field");
  if (field->sample.size() != field->blockCount()) {
    throw std::invalid_argument("compileStages: the field has no sample layer");
  }
  const double reach = reachOf(haptics, relief + roughness) / field->grid.voxel;
  if (reach + kBandBeyondReach > field->band) {
    std::string what;
    if (haptics.tip_radius) what = "tip.radius = " + formatLength(*haptics.tip_radius);
    const auto with = [&](const char* key, double length) {
      what += (what.empty() ? "" : " with ") + (key + (" = " + formatLength(length)));
    };
    if (haptics.offset) with("offset", *haptics.offset);
    if (haptics.magnet) with("magnet.range", haptics.magnet->range);
    if (relief > 0) with("relief, highest", relief);
    if (roughness > 0) with("roughness, peak", roughness);
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

// The shell over everything that is pulled, [m] above the field's surface.
struct Shell {
  double relief = 0, roughness = 0;
};

Shell shellOf(const PaintedRange& range) {
  const bool rough = range.has(MaterialChannel::roughness);
  return {range.relief, rough ? kRoughnessPeak * range.most.roughness : 0.0};
}

std::string namesOf(const PaintedRange& range) {
  std::string text;
  for (const MaterialChannel channel : kAllMaterialChannels)
    if (range.has(channel)) text += (text.empty() ? "" : ", ") + std::string(name(channel));
  return text + (text.empty() ? "neutral" : " painted");
}

template <class Part> std::size_t bytesOf(std::span<const FeltObject> objects, const Part& part) {
  std::size_t bytes = 0;
  for (const FeltObject& object : objects) bytes += part(object);
  return bytes;
}

// What a stage may be present for although the scene has no use for it.
enum class Unneeded { left_out, present };

std::shared_ptr<const HapticSnapshot> compiled(const Scene& scene, const HapticProperties& haptics,
                                               std::shared_ptr<const SurfaceField> field,
                                               std::span<const FeltObject> objects,
                                               const StabiliserPlan& plan, Unneeded unneeded) {
  auto snapshot = std::make_shared<HapticSnapshot>();
  snapshot->base = baseMaterial(haptics);
  const PaintedRange range = paintedRange(snapshot->base, objects);
  const Shell shell = shellOf(range);
  checkField(field.get(), haptics, shell.relief, shell.roughness);
  const bool all = unneeded == Unneeded::present;
  const auto add = [&](std::unique_ptr<const ForceStage> stage, std::string why,
                       std::size_t bytes = 0) {
    addStage(*snapshot, std::move(stage), std::move(why), bytes);
  };
  const double radius = haptics.tip_radius.value_or(0);
  const double iso = radius + haptics.offset.value_or(0) + shell.relief + shell.roughness;
  const std::string why = haptics.tip_radius ? "tip.radius = " + formatNumber(radius) : "always";
  if (haptics.contact == HapticProperties::Contact::ray)
    add(std::make_unique<RayStage>(field, scene.sampler, iso), why, bytesRead(*field));
  else
    add(std::make_unique<ProxyStage>(field, scene.sampler, iso, range.baked ? kBakedSteepness : 1),
        why, bytesRead(*field));
  if (haptics.offset) {
    add(std::make_unique<OffsetStage>(field, scene.sampler),
        "offset = " + formatNumber(*haptics.offset));
  }
  MagnetRelief raised;
  raised.leans = scene.relief.form == ForceForm::conservative;
  if (objects.size() > 1 && (range.any() || shell.relief > 0)) {
    add(std::make_unique<OwnerStage>(field, objects),
        std::to_string(objects.size()) + " objects, some painted");
    if (shell.relief > 0) raised.owners = std::make_shared<OwnerStage>(field, objects);
  }
  const bool slopes =
      range.has(MaterialChannel::stiffness) && scene.material_form == ForceForm::conservative;
  if (range.any() || all) {
    add(std::make_unique<MaterialStage>(field, scene.sampler, objects, slopes), namesOf(range),
        bytesOf(objects, [](const FeltObject& o) { return o.material ? o.material->bytes() : 0; }));
  }
  std::shared_ptr<const Reliefs> reliefs;
  if (shell.relief > 0 || all)
    reliefs = std::make_shared<const Reliefs>(field, scene.sampler, objects);
  if (plan.lateral || all) {
    add(std::make_unique<LateralStage>(reliefs, objects, shell.relief + shell.roughness,
                                       plan.lateral.value_or(LateralPlan{})),
        plan.lateral ? plan.lateral_why : "neutral");
  }
  if (reliefs) {
    add(std::make_unique<ReliefStage>(reliefs, shell.relief, scene.relief.form),
        shell.relief > 0 ? "relief up to " + formatLength(shell.relief) : "neutral",
        reliefs->bytes());
    if (shell.relief > 0) raised.reliefs = reliefs;
  }
  if (shell.roughness > 0 || all) {
    add(std::make_unique<RoughnessStage>(field, scene.sampler, objects, shell.roughness,
                                         scene.relief.form),
        shell.roughness > 0 ? "roughness up to " + formatLength(range.most.roughness) + " rms"
                            : "neutral");
  }
  const bool painted_friction =
      std::max(range.most.static_friction, range.most.dynamic_friction) > 0 && range.any();
  if (haptics.friction || painted_friction) {
    const Friction friction = scene.haptics.friction.value_or(Friction{});
    add(std::make_unique<FrictionStage>(field, scene.sampler, iso, friction,
                                        shell.relief + shell.roughness > 0),
        haptics.friction ? "friction.static = " + formatNumber(friction.static_coefficient)
                         : "friction is painted");
  }
  const MagnetMaker magnet = [&](const Magnet& spec) {
    return std::make_unique<MagnetStage>(field, scene.sampler, radius, spec, raised);
  };
  addForceLaw(*snapshot, haptics, range, plan, magnet, maxSpeed(field->grid), slopes || all);
  snapshot->field = std::move(field);
  return snapshot;
}

} // namespace

double reachOf(const HapticProperties& haptics, double relief) {
  return haptics.tip_radius.value_or(0) + relief +
         std::max(haptics.offset.value_or(0), haptics.magnet ? haptics.magnet->range : 0.0);
}

double raisedBy(std::span<const FeltObject> objects) {
  const Shell shell = shellOf(paintedRange({}, objects));
  return shell.relief + shell.roughness;
}

StabiliserPlan planOf(const Scene& scene, std::span<const FeltObject> objects) {
  const PaintedRange range = paintedRange(baseMaterial(scene.haptics), objects);
  const std::optional<double> most_damping =
      range.has(MaterialChannel::damping) ? std::optional(range.most.damping) : std::nullopt;
  // The literal force has no part along the surface.
  const bool leans = scene.relief.form == ForceForm::conservative;
  return planStabilisers(hardest(scene.haptics, range), scene.device_model, scene.stabilisers,
                         most_damping, leans ? range.bend : 0);
}

std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field,
                                                    std::span<const FeltObject> objects,
                                                    const StabiliserPlan& plan) {
  HapticProperties needed = scene.haptics;
  if (needed.friction && needed.friction->static_coefficient == 0) needed.friction.reset();
  if (needed.damping == 0.0) needed.damping.reset();
  if (needed.offset == 0.0) needed.offset.reset();
  if (needed.magnet && needed.magnet->range * needed.magnet->strength == 0) needed.magnet.reset();
  return compiled(scene, needed, std::move(field), objects, plan, Unneeded::left_out);
}

std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field,
                                                    std::span<const FeltObject> objects) {
  return compileStages(scene, std::move(field), objects, planOf(scene, objects));
}

std::shared_ptr<const HapticSnapshot> compileAllStages(const Scene& scene,
                                                       std::shared_ptr<const SurfaceField> field,
                                                       std::span<const FeltObject> objects) {
  HapticProperties all = scene.haptics;
  if (!all.friction) all.friction = Friction{};
  if (!all.damping) all.damping = 0;
  if (!all.magnet) all.magnet = Magnet{};
  return compiled(scene, all, std::move(field), objects, planOf(scene, objects), Unneeded::present);
}

Contact tick(const HapticSnapshot& snapshot, ContactMemory& memory, const Vec3& tip,
             double dt) noexcept {
  Contact contact;
  contact.tip = tip;
  contact.candidate = tip;
  contact.vcp = tip;
  contact.surface = tip;
  contact.material = snapshot.base;
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
