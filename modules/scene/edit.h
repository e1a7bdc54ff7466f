// Edits of a scene: the records of the history and of a workspace's journal.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scene/scene.h"
#include "scene/stroke.h"

namespace patina {

// Applies setValues() of scene.h.
struct ValueEdit {
  std::vector<std::pair<std::string, std::string>> values;
  bool operator==(const ValueEdit&) const = default;
};

// Any other edit (objects added, moved or removed; an image applied; everything erased). Keeps the
// whole resulting scene, which cannot be computed from a short record.
struct SceneEdit {
  std::string what; // "add pot", for the history's list
  std::shared_ptr<const Scene> scene;
};

using Edit = std::variant<Stroke, ValueEdit, SceneEdit>;

// Returns a text like "relief stroke, 0.3 mm", "stiffness = 800" or "add pot".
std::string describe(const Edit& edit);

} // namespace patina
