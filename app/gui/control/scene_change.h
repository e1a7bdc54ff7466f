// One step of the scene that is open, and what of it differs from before.
#pragma once

#include <memory>

#include "session/build/compile_scene.h"

namespace patina {

struct SceneChange {
  // Another scene, the same one after a preview stood in its place, or the same one edited.
  enum class Step { another, again, edited };

  std::shared_ptr<const CompiledScene> scene; // never null
  Step step = Step::another;
  bool surface = true; // mesh or field
  bool values = true;  // of touch, device and relief; or the surface
  bool device = true;
};

SceneChange editBetween(const CompiledScene& before, std::shared_ptr<const CompiledScene> now);

} // namespace patina
