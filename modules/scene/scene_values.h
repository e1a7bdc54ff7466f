// What is known of each key of a scene. The values themselves: setValue() and values() of scene.h.
#pragma once

#include <string>
#include <string_view>

namespace patina {

struct SceneKey {
  std::string_view key;
  std::string_view unit; // SI, or what is counted; "" = none
  std::string usual;     // of a new scene: the word for what values() leaves out; "none" = absent
};
const SceneKey& sceneKey(std::string_view key); // throws out_of_range if there is none

} // namespace patina
