// Converts a tick's contact into the sample for the window, recorders and files.
#pragma once

#include "haptics/contact/contact.h"
#include "scene/tool_sample.h"

namespace patina {

// Fills every member but the times. Servo thread: no lock, allocation or throw.
void record(const Contact& contact, ToolSample& sample) noexcept;

} // namespace patina
