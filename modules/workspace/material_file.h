// Painted material as bytes: a line of JSON, then the blocks as they are in memory.
#pragma once

#include <string>
#include <string_view>

#include "scene/paint/material_map.h"

namespace patina {

// Bit for bit. Throws Error for a value that is not finite, which could not be read again.
std::string materialBytes(const MaterialMap& map);
// Bounded by the size of `bytes`. Throws FileError(name).
MaterialMap parseMaterial(std::string_view bytes, const std::string& name);

} // namespace patina
