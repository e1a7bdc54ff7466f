// The files of a scan that commands read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/scan_samples.h"
#include "app/cli/output/console.h"

namespace patina::cli {

// The one that `option` named, or that of `name` in the folder of FRAMES. Throws Error where
// neither is: a camera or a video has none.
std::filesystem::path besideFrames(const std::filesystem::path& named, const std::string& option,
                                   const std::string& name, const std::string& frames);

// Of a path file, what can be registered onto a mesh of that length [m]: the samples in contact,
// without those that lie farther away than it is long, which is said.
std::vector<PathSample> readTouching(const std::filesystem::path& file, double length,
                                     Console& console);

} // namespace patina::cli
