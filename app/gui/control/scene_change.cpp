#include "app/gui/control/scene_change.h"

#include <utility>

#include "haptics/catalog/device_catalog.h"

namespace patina {
namespace {

bool sameDevice(const Scene& a, const Scene& b) {
  return a.device == b.device &&
         (!deviceNamed(a.device).uses_device_model || a.device_model == b.device_model);
}

bool sameValues(const Scene& a, const Scene& b) {
  return a.haptics == b.haptics && a.device == b.device && a.device_model == b.device_model &&
         a.stabilisers == b.stabilisers && a.relief == b.relief;
}

} // namespace

SceneChange editBetween(const CompiledScene& before, std::shared_ptr<const CompiledScene> now) {
  const bool surface = before.mesh != now->mesh || before.built.field != now->built.field;
  const bool values = surface || !sameValues(before.scene, now->scene);
  const bool device = !sameDevice(before.scene, now->scene);
  return {std::move(now), SceneChange::Step::edited, surface, values, device};
}

} // namespace patina
