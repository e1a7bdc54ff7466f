#include "scene/pin.h"

#include <algorithm>

#include "core/error.h"
#include "core/numbers.h"
#include "scene/scene.h"

namespace patina {
namespace {

Pin pinIn(std::string_view text) {
  const auto equal = text.find('=');
  Pin pin{std::string(text.substr(0, equal))};
  if (equal == std::string_view::npos || !isName(pin.name))
    throw Error("'" + std::string(text) + "' is not NAME=X,Y,Z");
  std::string_view rest = text.substr(equal + 1);
  for (int axis = 0; axis < 3; ++axis) {
    const auto end = axis < 2 ? rest.find(',') : rest.size();
    if (end == std::string_view::npos) throw Error("'" + std::string(text) + "' is not NAME=X,Y,Z");
    pin.position[axis] = parseLength(rest.substr(0, end));
    if (axis < 2) rest.remove_prefix(end + 1);
  }
  if (!pin.position.allFinite()) throw Error("'" + std::string(text) + "': it must be finite");
  return pin;
}

} // namespace

std::vector<Pin> parsePins(std::string_view text) {
  std::vector<Pin> pins;
  if (text.empty() || text == "none") return pins;
  while (true) {
    const auto end = text.find(';');
    const Pin pin = pinIn(text.substr(0, end));
    for (const Pin& other : pins)
      if (other.name == pin.name) throw Error("two pins are called " + pin.name);
    pins.push_back(pin);
    if (end == std::string_view::npos) return pins;
    text.remove_prefix(end + 1);
  }
}

std::string format(const std::vector<Pin>& pins) {
  std::string text;
  for (const Pin& pin : pins)
    text += (text.empty() ? "" : ";") + pin.name + "=" + formatNumber(pin.position.x()) + "," +
            formatNumber(pin.position.y()) + "," + formatNumber(pin.position.z());
  return text;
}

std::string nextPinName(const std::vector<Pin>& pins) {
  for (int round = 1;; ++round)
    for (char letter = 'A'; letter <= 'Z'; ++letter) {
      const std::string name = letter + (round > 1 ? std::to_string(round) : "");
      if (std::none_of(pins.begin(), pins.end(), [&](const Pin& pin) { return pin.name == name; }))
        return name;
    }
}

} // namespace patina
