// The values that differ between two scenes, as an edit that can be recorded.
#pragma once

#include <optional>

#include "scene/edit.h"

namespace patina {

// setValues() with it on `before` gives the values of `after`. Nullopt where they are the same.
// Objects and what is painted on them are no values.
std::optional<ValueEdit> valueEdit(const Scene& before, const Scene& after);

// What came first and what came then as one edit: of each key the last value.
ValueEdit merged(const ValueEdit& first, const ValueEdit& then);

} // namespace patina
