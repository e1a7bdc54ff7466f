// Edits reach the servo as a ramp: a value that jumps under a pressed tip would be a force that
// jumps, and that is a fault (F13).
#pragma once

#include "scene/scene.h"

namespace patina {

// The values one step of 30 Hz nearer to `wanted`: stiffness by 8 % at most, the tip's radius by
// 0.5 mm, damping by 2 N s/m, friction by 0.2. Equal to `wanted` after finitely many steps. A value
// that appears begins near nothing, one that goes away ends there.
HapticProperties steppedTowards(const HapticProperties& now, const HapticProperties& wanted);

bool same(const HapticProperties& a, const HapticProperties& b);

} // namespace patina
