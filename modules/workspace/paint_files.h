// Encodes paint: images as EXR; material as a line of JSON, then the blocks as they are in memory.
#pragma once

#include <string>
#include <string_view>

#include "scene/paint/material_map.h"
#include "scene/paint/tiled_image.h"

namespace patina {

// Encodes painted images.

// EXR in memory, bit for bit, as stored in a workspace. `name` is used in messages. Throws Error
// for a value that is not finite, FileError for unreadable data or another kind of image.
std::string exrBytes(const TiledImage& image);
TiledImage parseExr(std::string_view bytes, int channels, const std::string& name);

// Bit for bit. Throws Error for a value that is not finite, because the reader rejects it.
std::string materialBytes(const MaterialMap& map);
// Memory is bounded by the size of `bytes`. Throws FileError(name).
MaterialMap parseMaterial(std::string_view bytes, const std::string& name);

} // namespace patina
