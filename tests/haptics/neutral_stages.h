// A scene's law with every stage that the scene does not need, at its neutral value.
#pragma once

#include <map>
#include <string_view>

#include "haptics/contact_fixture.h"
#include "haptics/law/friction_stage.h"
#include "haptics/law/lateral_stage.h"
#include "haptics/law/magnet_stage.h"
#include "haptics/law/material_stage.h"
#include "haptics/law/relief_stage.h"
#include "haptics/law/spring_stage.h"

namespace patina {

// Forwards to a stage of another snapshot, which it keeps alive.
class BorrowedStage final : public ForceStage {
 public:
  BorrowedStage(std::shared_ptr<const HapticSnapshot> from, std::size_t index)
      : from_(std::move(from)), stage_(*from_->stages[index]) {}
  void apply(Contact& contact, ContactMemory& memory) const noexcept override {
    stage_.apply(contact, memory);
  }

 private:
  std::shared_ptr<const HapticSnapshot> from_;
  const ForceStage& stage_;
};

// A coupling is spring and damping in one; a cut-off, an offset, an owner and a passivity
// controller have no neutral value.
inline std::shared_ptr<const HapticSnapshot>
withNeutralStages(const Scene& scene, const Field& field, std::span<const HapticObject> felt = {}) {
  const auto pruned = compileStages(scene, field, felt);
  auto full = std::make_shared<HapticSnapshot>();
  full->field = field;
  full->objects.assign(felt.begin(), felt.end());
  full->base = pruned->base;
  const std::span<const HapticObject> objects = full->objects;
  const FieldSampler sampler(*field, scene.sampler);
  const auto reliefs = std::make_shared<const Reliefs>(sampler, objects);
  const ForceForm form = scene.relief.form;
  const double radius = scene.haptics.tip_radius.value_or(0);
  std::map<std::string_view, std::unique_ptr<const ForceStage>> neutral;
  neutral["material"] = std::make_unique<MaterialStage>(objects, false);
  neutral["texture stiffness"] = std::make_unique<TextureStiffnessStage>(reliefs, false);
  neutral["lateral coupling"] =
      std::make_unique<LateralStage>(reliefs, objects, reliefOver(felt), LateralPlan{});
  neutral["relief"] = std::make_unique<ReliefStage>(reliefs, 0, form);
  neutral["roughness"] = std::make_unique<RoughnessStage>(sampler, objects, 0, form);
  neutral["friction"] = std::make_unique<FrictionStage>(sampler, radius, Friction{}, false);
  neutral["magnet"] = std::make_unique<MagnetStage>(sampler, radius, Magnet{}, MagnetRelief{}, 0);
  if (!pruned->stabilisers.coupling) neutral["damping"] = std::make_unique<DampingStage>();
  neutral["stiffness slope"] = std::make_unique<StiffnessGradientStage>(sampler);

  // The stages have the order of compileStages() and addForceLaw().
  std::vector<const char*> order = {"contact", "offset", "owner"};
  const auto then = [&](std::initializer_list<const char*> names) {
    order.insert(order.end(), names);
  };
  if (pruned->stabilisers.lateral)
    then({"material", "texture stiffness", "lateral coupling", "relief"});
  else
    then({"lateral coupling", "relief", "material", "texture stiffness"});
  then({"roughness", "texture layer", "friction", "spring", "magnet", "coupling", "velocity filter",
        "damping", "stiffness slope", "passivity", "limit"});
  std::size_t taken = 0;
  for (const char* const name : order) {
    if (taken < pruned->stages.size() && pruned->why[taken].name == name)
      full->add(name, std::make_unique<BorrowedStage>(pruned, taken++), "needed");
    else if (const auto found = neutral.find(name); found != neutral.end())
      full->add(name, std::move(found->second), "neutral");
  }
  if (taken != pruned->stages.size()) throw std::logic_error("a stage is not in the order");
  return full;
}

} // namespace patina
