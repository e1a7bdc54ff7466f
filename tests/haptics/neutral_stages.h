// A scene's law with every stage it does without, at its neutral value.
#pragma once

#include "haptics/contact_fixture.h"
#include "haptics/stages/friction_stage.h"
#include "haptics/stages/lateral_stage.h"
#include "haptics/stages/magnet_stage.h"
#include "haptics/stages/material_stage.h"
#include "haptics/stages/relief_stage.h"
#include "haptics/stages/spring_stage.h"

namespace patina {

// A stage of another snapshot, which it keeps.
class BorrowedStage final : public ForceStage {
 public:
  BorrowedStage(std::shared_ptr<const HapticSnapshot> from, std::size_t index)
      : from_(std::move(from)), stage_(*from_->stages[index]) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override {
    stage_.apply(contact, memory);
  }
  std::string_view name() const noexcept override { return stage_.name(); }

 private:
  std::shared_ptr<const HapticSnapshot> from_;
  const ForceStage& stage_;
};

// A coupling is spring and damping in one; a cut-off, an offset, an owner and a passivity
// controller have no neutral value.
inline std::shared_ptr<const HapticSnapshot>
withNeutralStages(const Scene& scene, const Field& field, std::span<const FeltObject> felt = {}) {
  const auto pruned = compileStages(scene, field, felt);
  auto full = std::make_shared<HapticSnapshot>();
  full->field = field;
  full->objects.assign(felt.begin(), felt.end());
  full->base = pruned->base;
  const std::span<const FeltObject> objects = full->objects;
  const FieldSampler sampler(*field, scene.sampler);
  const auto reliefs = std::make_shared<const Reliefs>(sampler, objects);
  const ForceForm form = scene.relief.form;
  const double radius = scene.haptics.tip_radius.value_or(0);
  std::vector<std::unique_ptr<const ForceStage>> neutral;
  neutral.push_back(std::make_unique<MaterialStage>(objects, false));
  neutral.push_back(std::make_unique<TextureStiffnessStage>(reliefs, false));
  neutral.push_back(
      std::make_unique<LateralStage>(reliefs, objects, raisedBy(felt), LateralPlan{}));
  neutral.push_back(std::make_unique<ReliefStage>(reliefs, 0, form));
  neutral.push_back(std::make_unique<RoughnessStage>(sampler, objects, 0, form));
  neutral.push_back(std::make_unique<FrictionStage>(sampler, radius, Friction{}, false));
  neutral.push_back(std::make_unique<MagnetStage>(sampler, radius, Magnet{}, MagnetRelief{}));
  if (!pruned->stabilisers.coupling) neutral.push_back(std::make_unique<DampingStage>());
  neutral.push_back(std::make_unique<StiffnessSlopeStage>(sampler));

  // The order of addForceLaw() and compileStages().
  const char* const order[] = {
      "contact",          "offset",    "owner",     "material",        "texture stiffness",
      "lateral coupling", "relief",    "roughness", "texture layer",   "friction",
      "spring",           "magnet",    "coupling",  "velocity filter", "damping",
      "stiffness slope",  "passivity", "limit"};
  std::size_t taken = 0;
  for (const std::string_view name : order) {
    if (taken < pruned->stages.size() && pruned->stages[taken]->name() == name) {
      full->add(std::make_unique<BorrowedStage>(pruned, taken++), "needed");
      continue;
    }
    for (auto& stage : neutral)
      if (stage && stage->name() == name) full->add(std::move(stage), "neutral");
  }
  if (taken != pruned->stages.size()) throw std::logic_error("a stage is not in the order");
  return full;
}

} // namespace patina
