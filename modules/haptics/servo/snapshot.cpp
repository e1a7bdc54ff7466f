#include "haptics/servo/snapshot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/numbers.h"
#include "haptics/contact/offset_stage.h"
#include "haptics/contact/proxy_stage.h"
#include "haptics/contact/ray_stage.h"
#include "haptics/stages/force_law.h"
#include "haptics/stages/friction_stage.h"
#include "haptics/stages/lateral_stage.h"
#include "haptics/stages/limit_stage.h"
#include "haptics/stages/magnet_stage.h"
#include "haptics/stages/material_stage.h"
#include "haptics/stages/relief_stage.h"

namespace patina {
namespace {

constexpr double kMinVelocityPeriod = 1e-6; // [s]; less measures nothing
// Of baked relief; what is steeper is not crossed unseen but for parts thinner than a voxel.
constexpr double kBakedSteepness = 4;
constexpr double kMaxVelocity = 1e6; // [m/s]; beyond it the tip was set, not moved

void checkField(const SurfaceField* field, const HapticProperties& haptics, double relief,
                double roughness) {
  if (!field) throw std::invalid_argument("compileStages: no field");
  if (field->sample.size() != field->blockCount())
    throw std::invalid_argument("compileStages: the field has no sample layer");
  const double band = feltReach(haptics, relief + roughness).band(field->grid.voxel);
  if (band > field->band) {
    std::string what;
    const auto with = [&](const char* key, double length) {
      what += (what.empty() ? "" : " with ") + (key + (" = " + formatLength(length)));
    };
    if (haptics.tip_radius) with("tip.radius", *haptics.tip_radius);
    if (haptics.offset) with("offset", *haptics.offset);
    if (haptics.magnet) with("magnet.range", haptics.magnet->range);
    if (relief > 0) with("relief, highest", relief);
    if (roughness > 0) with("roughness, peak", roughness);
    throw Error(what + " does not fit into the band of " + formatNumber(field->band) +
                " voxels; set band to " + formatNumber(std::ceil(band)) + " or more");
  }
}

std::size_t bytesRead(const SurfaceField& field) {
  std::size_t bytes = 0;
  for (const LayerBytes& layer : field.layerBytes()) {
    if (layer.name == "top" || layer.name == "sample" || layer.name == "coarse")
      bytes += layer.bytes;
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
  double relief = 0, roughness = 0, layer = 0;
  double whole() const { return relief + roughness + layer; }
};

Shell shellOf(const PaintedRange& range) {
  const bool rough = range.has(MaterialChannel::roughness);
  return {range.relief, rough ? kRoughnessPeak * range.most.roughness : 0.0, range.layer};
}

std::string namesOf(const PaintedRange& range) {
  std::string text;
  for (const MaterialChannel channel : kAllMaterialChannels)
    if (range.has(channel)) text += (text.empty() ? "" : ", ") + std::string(name(channel));
  return text + " painted";
}

} // namespace

void HapticSnapshot::add(const char* name, std::unique_ptr<const ForceStage> stage,
                         std::string reason, std::size_t bytes) {
  why.push_back({name, std::move(reason), bytes});
  stages.push_back(std::move(stage));
}

FeltReach feltReach(const HapticProperties& haptics, double raised) {
  return {haptics.tip_radius.value_or(0), raised,
          std::max(haptics.offset.value_or(0), haptics.magnet ? haptics.magnet->range : 0.0)};
}

double raisedBy(std::span<const FeltObject> objects) {
  return shellOf(paintedRange({}, objects)).whole();
}

StabiliserPlan planOf(const Scene& scene, std::span<const FeltObject> objects) {
  const PaintedRange range = paintedRange(baseMaterial(scene.haptics), objects);
  const std::optional<double> most_damping =
      range.has(MaterialChannel::damping) ? std::optional(range.most.damping) : std::nullopt;
  // The literal force has no part along the surface.
  const bool leans = scene.relief.form == ForceForm::conservative;
  HapticProperties haptics = hardest(scene.haptics, range);
  if (range.layer > 0) haptics.stiffness *= 1 + *scene.haptics.texture_gain;
  return planStabilisers(haptics, scene.device_model, scene.stabilisers, most_damping,
                         leans ? range.bend : 0);
}

std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field,
                                                    std::span<const FeltObject> felt,
                                                    const StabiliserPlan& plan) {
  HapticProperties haptics = scene.haptics;
  if (haptics.friction && haptics.friction->static_coefficient == 0) haptics.friction.reset();
  if (haptics.damping == 0.0) haptics.damping.reset();
  if (haptics.offset == 0.0) haptics.offset.reset();
  if (haptics.magnet && haptics.magnet->range * haptics.magnet->strength == 0)
    haptics.magnet.reset();

  auto snapshot = std::make_shared<HapticSnapshot>();
  snapshot->base = baseMaterial(haptics);
  snapshot->objects.assign(felt.begin(), felt.end());
  const std::span<const FeltObject> objects = snapshot->objects;
  const PaintedRange range = paintedRange(snapshot->base, objects);
  const Shell shell = shellOf(range);
  checkField(field.get(), haptics, shell.relief + shell.layer, shell.roughness);
  const FieldSampler sampler(*field, scene.sampler);
  const double radius = haptics.tip_radius.value_or(0);
  const double iso = radius + haptics.offset.value_or(0) + shell.whole();
  const bool slopes = (range.has(MaterialChannel::stiffness) || range.texture_stiffness > 0) &&
                      scene.material_form == ForceForm::conservative;
  const bool leans = shell.whole() > 0 && scene.relief.form == ForceForm::conservative;
  const std::string why = haptics.tip_radius ? "tip.radius = " + formatNumber(radius) : "always";
  if (haptics.contact == HapticProperties::Contact::ray)
    snapshot->add("contact", std::make_unique<RayStage>(sampler, iso), why, bytesRead(*field));
  else
    snapshot->add("contact",
                  std::make_unique<ProxyStage>(sampler, iso, range.baked ? kBakedSteepness : 1,
                                               slopes || leans),
                  why, bytesRead(*field));
  if (haptics.offset)
    snapshot->add("offset", std::make_unique<OffsetStage>(sampler),
                  "offset = " + formatNumber(*haptics.offset));
  MagnetRelief raised;
  raised.leans = scene.relief.form == ForceForm::conservative;
  if (objects.size() > 1 && (range.any() || shell.relief + shell.layer > 0)) {
    snapshot->add("owner", std::make_unique<OwnerStage>(sampler, objects),
                  std::to_string(objects.size()) + " objects, some painted");
    if (shell.relief > 0) raised.owners = std::make_shared<OwnerStage>(sampler, objects);
  }
  if (shell.relief > 0) raised.reliefs = std::make_shared<const Reliefs>(sampler, objects);
  const auto addMaterial = [&] {
    if (range.any()) {
      std::size_t bytes = 0;
      for (const FeltObject& object : objects)
        bytes += object.material ? object.material->bytes() : 0;
      snapshot->add("material", std::make_unique<MaterialStage>(objects, slopes), namesOf(range),
                    bytes);
    }
    if (range.texture_stiffness > 0)
      snapshot->add(
          "texture stiffness", std::make_unique<TextureStiffnessStage>(raised.reliefs, slopes),
          "textures of up to " + formatNumber(std::round(range.texture_stiffness)) + " N/m");
  };
  if (plan.lateral) {
    addMaterial();
    snapshot->add(
        "lateral coupling",
        std::make_unique<LateralStage>(raised.reliefs, objects, shell.whole(), *plan.lateral),
        plan.lateral_why);
  }
  if (raised.reliefs)
    snapshot->add("relief",
                  std::make_unique<ReliefStage>(raised.reliefs, shell.relief, scene.relief.form),
                  "relief up to " + formatLength(shell.relief), raised.reliefs->bytes());
  // The force waits for the relief longest: what need not come before it is read meanwhile.
  if (!plan.lateral) addMaterial();
  if (shell.roughness > 0)
    snapshot->add(
        "roughness",
        std::make_unique<RoughnessStage>(sampler, objects, shell.roughness, scene.relief.form),
        "roughness up to " + formatLength(range.most.roughness) + " rms");
  if (shell.layer > 0) {
    auto layers = std::make_shared<const Reliefs>(sampler, objects, &FeltObject::layer);
    const std::size_t bytes = layers->bytes();
    snapshot->add("texture layer",
                  std::make_unique<TextureLayerStage>(std::move(layers), shell.layer,
                                                      *haptics.texture_gain, scene.relief.form),
                  "texture.gain = " + formatNumber(*haptics.texture_gain), bytes);
  }
  const bool painted_friction =
      std::max(range.most.static_friction, range.most.dynamic_friction) > 0 && range.any();
  if (haptics.friction || painted_friction) {
    const Friction friction = scene.haptics.friction.value_or(Friction{});
    snapshot->add(
        "friction", std::make_unique<FrictionStage>(sampler, iso, friction, shell.whole() > 0),
        haptics.friction ? "friction.static = " + formatNumber(friction.static_coefficient)
                         : "friction is painted");
  }
  std::unique_ptr<const ForceStage> magnet;
  if (haptics.magnet) {
    haptics.magnet->strength = plan.softened(haptics.magnet->strength);
    magnet = std::make_unique<MagnetStage>(sampler, radius, *haptics.magnet, raised,
                                           snapshot->base.damping);
  }
  addForceLaw(*snapshot, haptics, range, plan, std::move(magnet), maxSpeed(field->grid),
              slopes ? &sampler : nullptr);
  snapshot->field = std::move(field);
  return snapshot;
}

std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field,
                                                    std::span<const FeltObject> objects) {
  return compileStages(scene, std::move(field), objects, planOf(scene, objects));
}

Contact beginTick(const HapticSnapshot& snapshot, const ContactMemory& memory, const Vec3& tip,
                  double dt) noexcept {
  Contact contact;
  contact.tip = contact.candidate = contact.vcp = contact.surface = tip;
  contact.material = snapshot.base;
  contact.dt = memory.tip.gap + (dt > 0 && dt < 1e6 ? dt : 0);
  contact.lets_go = memory.limit.jumped;
  if (memory.tip.last && contact.dt >= kMinVelocityPeriod) {
    contact.velocity = 1 / contact.dt * (tip - *memory.tip.last);
    // Also where it is infinite or NaN, which no filter would ever forget.
    if (!(contact.velocity.squaredNorm() < kMaxVelocity * kMaxVelocity)) contact.velocity.setZero();
  }
  return contact;
}

Contact tick(const HapticSnapshot& snapshot, ContactMemory& memory, const Vec3& tip,
             double dt) noexcept {
  Contact contact = beginTick(snapshot, memory, tip, dt);
  if (!tip.allFinite()) {
    memory.tip.gap = contact.dt;
    memory.tip.applied.setZero();
    return contact;
  }
  for (const auto& stage : snapshot.stages) stage->apply(contact, memory);
  if (!memory.contact.c) memory.leaveContact();
  memory.tip.last = tip;
  memory.tip.gap = 0;
  memory.tip.applied = contact.force;
  return contact;
}

} // namespace patina
