// A pose as a person writes it: 4 x 4 numbers in a text file.
#pragma once

#include <filesystem>

#include "core/types.h"

namespace patina::cli {

// Row by row, '#' starts a comment. Throws FileError naming the line: a word that is no finite
// number, too few or too many, a last row other than 0 0 0 1, not a rotation.
Pose readPose(const std::filesystem::path& path);

} // namespace patina::cli
