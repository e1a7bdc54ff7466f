// One tick as the window, recorders and files see it.
#pragma once

#include "field/store/surface_field.h"
#include "haptics/contact/contact.h"
#include "scene/tool_sample.h"

namespace patina {

// Fills all but the times. `field` is the one that was felt; null: there is none. Servo thread: no
// lock, allocation or throw.
void record(const Contact& contact, const SurfaceField* field, ToolSample& sample) noexcept;

} // namespace patina
