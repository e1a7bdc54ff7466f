// A painted image as the bytes of a file.
#pragma once

#include <string>
#include <string_view>

#include "scene/paint/tiled_image.h"

namespace patina {

// Bit for bit, in memory, as EXR: what a workspace keeps. `name` is used in messages. Throws Error
// for a value that is not finite, FileError for what cannot be read or is not a painted image.
std::string exrBytes(const TiledImage& image);
TiledImage parseExr(std::string_view bytes, int channels, const std::string& name);

} // namespace patina
