// What a person did to a scene: the records of the history and of a workspace's journal.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scene/scene.h"
#include "scene/stroke.h"

namespace patina {

// setValues() of scene.h.
struct ValueEdit {
  std::vector<std::pair<std::string, std::string>> values;
  bool operator==(const ValueEdit&) const = default;
};

// Anything else (objects added, moved, removed; an image laid on; everything wiped): the scene
// afterwards, which is kept whole since it cannot be made again from its record.
struct SceneEdit {
  std::string what; // "add pot", for the history's list
  std::shared_ptr<const Scene> scene;
};

using Edit = std::variant<Stroke, ValueEdit, SceneEdit>;

// "relief stroke, 0.3 mm", "stiffness = 800", "add pot".
std::string describe(const Edit& edit);

} // namespace patina
