// Named points of a scene at which values are read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/types.h"

namespace patina {

struct Pin {
  std::string name;             // unique in the scene; a name as of objects
  Vec3 position = Vec3::Zero(); // [m], world frame
  bool operator==(const Pin&) const = default;
};

// Parses "A=0.01,0,0.03;B=12mm,0,3mm"; "none" gives no pins. Throws Error for a wrong or repeated
// name and for a position that is not X,Y,Z.
std::vector<Pin> parsePins(std::string_view text);
std::string format(const std::vector<Pin>& pins); // such a text, in metres
// Returns the first of A, B … Z, A2, B2 … that no pin has.
std::string nextPinName(const std::vector<Pin>& pins);

} // namespace patina
