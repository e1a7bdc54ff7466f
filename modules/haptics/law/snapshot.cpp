#include "haptics/law/snapshot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/numbers.h"
#include "field/sampling/field_sampler.h"
#include "haptics/law/force_law.h"
#include "haptics/law/friction_stage.h"
#include "haptics/law/lateral_stage.h"
#include "haptics/law/limit_stage.h"
#include "haptics/law/magnet_stage.h"
#include "haptics/law/material_stage.h"
#include "haptics/law/proxy_stage.h"
#include "haptics/law/ray_stage.h"
#include "haptics/law/relief_stage.h"
#include "haptics/law/stage.h"

namespace patina {
namespace {

// Offset surface: contact at a distance from the model, along the model's normal (K12).

// Follows a contact stage with iso-value tip radius + offset, whose contact point keeps this
// distance from the model, also at edges and corners. Finds the model's closest point for display
// and material: a Newton step projects Contact::surface onto phi = 0 within O(h^2).
class OffsetStage final : public ForceStage {
 public:
  explicit OffsetStage(const FieldSampler& sampler) : sampler_(sampler) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override;

 private:
  FieldSampler sampler_;
};

constexpr double kMinGradient = 0.1; // K05
constexpr double kMaxNewtonStep = 1; // voxels; a longer step would leave the part near the tip

void OffsetStage::apply(Contact& contact, ContactMemory&) const noexcept {
  if (!contact.touching || contact.normal.isZero(0)) return;
  const FieldGrid& grid = sampler_.grid();
  const GridSample at = sampler_.atGrid(sampler_.toGrid(contact.surface));
  ++contact.samples;
  const double slope = at.gradient.norm();
  if (!(slope >= kMinGradient) || !(std::abs(at.phi) <= kMaxNewtonStep)) return;
  const Vec3 normal = at.gradient / slope;
  if (!(normal.dot(contact.normal) > 0)) return; // opposite side of a thin part
  contact.surface -= grid.voxel * at.phi * normal;
}

constexpr double kMinVelocityPeriod = 1e-6; // shorter periods are not measurable [s]
// Assumed bound of |grad phi| of a field with baked relief: a search steps by height / 4.
constexpr double kBakedLipschitz = 4;
constexpr double kMaxVelocity = 1e6; // [m/s]; a faster tip was set, not moved

void checkField(const SurfaceField* field, const HapticProperties& haptics, double relief,
                double roughness) {
  if (!field) throw std::invalid_argument("compileStages: no field");
  if (field->sample.size() != field->blockCount())
    throw std::invalid_argument("compileStages: the field has no sample layer");
  const double band = interactionRange(haptics, relief + roughness).band(field->grid.voxel);
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
    if (what.empty()) what = "contact";
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

// v_max of the jump fault: hand speed, scaled up for a model larger than its workspace.
double maxSpeed(const FieldGrid& grid) {
  const int cells = *std::max_element(grid.nodes.begin(), grid.nodes.end()) - 1;
  return kHandSpeed * std::max(1.0, cells * grid.voxel / kHandWorkspace);
}

// Heights of the relief envelope above the field's surface [m].
struct ReliefEnvelope {
  double relief = 0, roughness = 0, layer = 0;
  double total() const { return relief + roughness + layer; }
};

ReliefEnvelope reliefEnvelope(const PaintedRange& range) {
  const bool rough = range.has(MaterialChannel::roughness);
  return {range.relief, rough ? kRoughnessPeak * range.max.roughness : 0.0, range.layer};
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

InteractionRange interactionRange(const HapticProperties& haptics, double max_relief) {
  return {haptics.tip_radius.value_or(0), max_relief,
          std::max(haptics.offset.value_or(0), haptics.magnet ? haptics.magnet->range : 0.0)};
}

double reliefOver(std::span<const HapticObject> objects) {
  return reliefEnvelope(paintedRange({}, objects)).total();
}

StabiliserPlan planOf(const Scene& scene, std::span<const HapticObject> objects) {
  const PaintedRange range = paintedRange(baseMaterial(scene.haptics), objects);
  const std::optional<double> max_damping =
      range.has(MaterialChannel::damping) ? std::optional(range.max.damping) : std::nullopt;
  // The literal force has no tangential part.
  const bool tilt_normal = scene.relief.form == ForceForm::conservative;
  HapticProperties haptics = worstCase(scene.haptics, range);
  if (range.layer > 0) haptics.stiffness *= 1 + *scene.haptics.texture_gain;
  return planStabilisers(haptics, scene.device_model, scene.stabilisers, max_damping,
                         tilt_normal ? range.max_curvature : 0);
}

std::shared_ptr<const HapticSnapshot> compileStages(const Scene& scene,
                                                    std::shared_ptr<const SurfaceField> field,
                                                    std::span<const HapticObject> painted,
                                                    const StabiliserPlan& plan) {
  HapticProperties haptics = scene.haptics;
  if (haptics.friction && haptics.friction->static_coefficient == 0) haptics.friction.reset();
  if (haptics.damping == 0.0) haptics.damping.reset();
  if (haptics.offset == 0.0) haptics.offset.reset();
  if (haptics.magnet && haptics.magnet->range * haptics.magnet->strength == 0)
    haptics.magnet.reset();

  auto snapshot = std::make_shared<HapticSnapshot>();
  snapshot->base = baseMaterial(haptics);
  snapshot->objects.assign(painted.begin(), painted.end());
  const std::span<const HapticObject> objects = snapshot->objects;
  const PaintedRange range = paintedRange(snapshot->base, objects);
  const ReliefEnvelope envelope = reliefEnvelope(range);
  checkField(field.get(), haptics, envelope.relief + envelope.layer, envelope.roughness);
  const FieldSampler sampler(*field, scene.sampler);
  const double radius = haptics.tip_radius.value_or(0);
  const double iso = radius + haptics.offset.value_or(0) + envelope.total();
  const bool slopes = (range.has(MaterialChannel::stiffness) || range.texture_stiffness > 0) &&
                      scene.material_form == ForceForm::conservative;
  const bool tilt_normal = envelope.total() > 0 && scene.relief.form == ForceForm::conservative;
  const std::string why = haptics.tip_radius ? "tip.radius = " + formatNumber(radius) : "always";
  if (haptics.contact == HapticProperties::Contact::ray)
    snapshot->add("contact", std::make_unique<RayStage>(sampler, iso), why, bytesRead(*field));
  else
    snapshot->add("contact",
                  std::make_unique<ProxyStage>(sampler, iso, range.baked ? kBakedLipschitz : 1,
                                               slopes || tilt_normal),
                  why, bytesRead(*field));
  if (haptics.offset)
    snapshot->add("offset", std::make_unique<OffsetStage>(sampler),
                  "offset = " + formatNumber(*haptics.offset));
  MagnetRelief raised;
  raised.tilt_normal = scene.relief.form == ForceForm::conservative;
  if (objects.size() > 1 && (range.any() || envelope.relief + envelope.layer > 0)) {
    snapshot->add("owner", std::make_unique<OwnerStage>(sampler, objects),
                  std::to_string(objects.size()) + " objects, some painted");
    if (envelope.relief > 0) raised.owners = std::make_shared<OwnerStage>(sampler, objects);
  }
  if (envelope.relief > 0) raised.reliefs = std::make_shared<const Reliefs>(sampler, objects);
  const auto addMaterial = [&] {
    if (range.any()) {
      std::size_t bytes = 0;
      for (const HapticObject& object : objects)
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
        std::make_unique<LateralStage>(raised.reliefs, objects, envelope.total(), *plan.lateral),
        plan.lateral_why);
  }
  if (raised.reliefs)
    snapshot->add("relief",
                  std::make_unique<ReliefStage>(raised.reliefs, envelope.relief, scene.relief.form),
                  "relief up to " + formatLength(envelope.relief), raised.reliefs->bytes());
  // The force needs relief last, so independent stages run before it to hide its latency.
  if (!plan.lateral) addMaterial();
  if (envelope.roughness > 0)
    snapshot->add(
        "roughness",
        std::make_unique<RoughnessStage>(sampler, objects, envelope.roughness, scene.relief.form),
        "roughness up to " + formatLength(range.max.roughness) + " rms");
  if (envelope.layer > 0) {
    auto layers = std::make_shared<const Reliefs>(sampler, objects, &HapticObject::layer);
    const std::size_t bytes = layers->bytes();
    snapshot->add("texture layer",
                  std::make_unique<TextureLayerStage>(std::move(layers), envelope.layer,
                                                      *haptics.texture_gain, scene.relief.form),
                  "texture.gain = " + formatNumber(*haptics.texture_gain), bytes);
  }
  const bool painted_friction =
      std::max(range.max.static_friction, range.max.dynamic_friction) > 0 && range.any();
  if (haptics.friction || painted_friction) {
    const Friction friction = scene.haptics.friction.value_or(Friction{});
    snapshot->add(
        "friction", std::make_unique<FrictionStage>(sampler, iso, friction, envelope.total() > 0),
        haptics.friction ? "friction.static = " + formatNumber(friction.static_coefficient)
                         : "friction is painted");
  }
  std::unique_ptr<const ForceStage> magnet;
  if (haptics.magnet) {
    haptics.magnet->strength = plan.seriesStiffness(haptics.magnet->strength);
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
                                                    std::span<const HapticObject> objects) {
  return compileStages(scene, std::move(field), objects, planOf(scene, objects));
}

Contact beginTick(const HapticSnapshot& snapshot, const ContactMemory& memory, const Vec3& tip,
                  double dt) noexcept {
  Contact contact;
  contact.tip = contact.frictionless_point = contact.vcp = contact.surface = tip;
  contact.material = snapshot.base;
  contact.dt = memory.tip.gap + (dt > 0 && dt < 1e6 ? dt : 0);
  contact.release_stick = memory.limit.jumped;
  if (memory.tip.last && contact.dt >= kMinVelocityPeriod) {
    contact.velocity = 1 / contact.dt * (tip - *memory.tip.last);
    // Rejects infinity and NaN too, which no filter would ever forget.
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
