// The files of a scan that commands read.
#pragma once

#include <filesystem>
#include <string>

namespace patina::cli {

// The one that `option` named, or that of `name` in the folder of FRAMES. Throws Error where
// neither is: a camera or a video has none.
std::filesystem::path besideFrames(const std::filesystem::path& named, const std::string& option,
                                   const std::string& name, const std::string& frames);

} // namespace patina::cli
