// Capabilities of a device as stated by its maker.
#pragma once

#include <optional>

#include "core/types.h"

namespace patina {

// A value is absent if it is unknown or does not apply.
struct DeviceLimits {
  std::optional<Box3> workspace{};       // [m], device frame
  std::optional<double> max_force{};     // [N]; 0: renders no force
  std::optional<double> max_stiffness{}; // largest displayable stiffness [N/m]
};

} // namespace patina
