// A change of the open scene, and which parts differ from before.
#pragma once

#include <memory>

#include "session/compile/compile_scene.h"

namespace patina {

struct SceneChange {
  // Another scene; the same one shown again after a preview; or the same one edited.
  enum class Step { another, again, edited };

  std::shared_ptr<const CompiledScene> scene; // Never nullptr.
  Step step = Step::another;
  bool surface = true; // Mesh or field.
  bool values = true;  // Touch, device, relief or surface.
  bool device = true;
};

SceneChange editBetween(const CompiledScene& before, std::shared_ptr<const CompiledScene> now);

} // namespace patina
