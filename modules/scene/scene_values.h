// Descriptions of the scene keys. See setValue() and values() of scene.h for their values.
#pragma once

#include <string>
#include <string_view>

namespace patina {

struct SceneKey {
  std::string_view key;
  std::string_view unit;     // SI, or the counted thing; "" = none
  std::string default_value; // value in a new scene, which values() omits; "none" = absent
};
const SceneKey& sceneKey(std::string_view key); // throws out_of_range for an unknown key

} // namespace patina
