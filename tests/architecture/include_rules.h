// Include rules (docs/architecture.md), as a pure function of a file's path and text.
#pragma once

#include <string>
#include <vector>

#include "architecture/project_files.h"

namespace patina::architecture {

// Returns one line for each forbidden #include: "path:line: cause".
std::vector<std::string> includeViolations(const SourceFile& file);

} // namespace patina::architecture
