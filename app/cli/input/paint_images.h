// Painted images as pictures beside an export.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/output/console.h"
#include "scene/scene.h"

namespace patina::cli {

// OBJECT-color and OBJECT-relief, each as .png (16 bits; relief cut to 0..1, with a warning) and
// .exr (floats, bit for bit; relief as it is, of which relief.height is one). Colour is not
// premultiplied. Returns the file names. Throws FileError.
std::vector<std::string> writePaintImages(const Scene& scene, const std::filesystem::path& folder,
                                          Console& console);

} // namespace patina::cli
