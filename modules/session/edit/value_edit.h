// Differences of values between two scenes, as an edit that can be recorded.
#pragma once

#include <optional>

#include "scene/edit.h"

namespace patina {

// setValues() with the result on `before` gives the values of `after`. Nullopt if they are equal.
// Objects and their paint are not values.
std::optional<ValueEdit> valueEdit(const Scene& before, const Scene& after);

// Combines two successive edits: the last value of each key.
ValueEdit merged(const ValueEdit& first, const ValueEdit& then);

} // namespace patina
