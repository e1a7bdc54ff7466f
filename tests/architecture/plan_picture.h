// The picture of the plan in docs/architecture.md, drawn from the build files and floors.txt.
#pragma once

#include <string>

namespace patina::architecture {

// Returns an SVG: one box a room with its floors, rows from the rooms that depend on nothing to
// app.
std::string planPicture();

} // namespace patina::architecture
