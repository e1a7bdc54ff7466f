// Finds the files of a scan.
#pragma once

#include <filesystem>
#include <string>

namespace patina::cli {

// Returns the file given by `option`, or the one called `name` in the folder of FRAMES. Throws
// Error if neither exists; a camera or a video has no folder.
std::filesystem::path scanFile(const std::filesystem::path& named, const std::string& option,
                               const std::string& name, const std::string& frames);

} // namespace patina::cli
