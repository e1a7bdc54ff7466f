// A recorded tip as CSV: t [s],x [m],y [m],z [m].
#pragma once

#include <filesystem>
#include <vector>

#include "haptics/servo/feel.h"

namespace patina::cli {

// Throws FileError with the line: wrong header, a bad number, time that does not increase, no row.
std::vector<TimedTip> readTipPath(const std::filesystem::path& path);

} // namespace patina::cli
