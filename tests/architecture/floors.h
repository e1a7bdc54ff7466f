// The floors inside the rooms (modules/floors.txt): no folder may include one above it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "architecture/project_files.h"

namespace patina::architecture {

// The floor of each folder, 0 is the lowest; "." stands for the room's own files.
using Floors = std::map<std::string, std::map<std::string, int>>;

// Reads the table. Throws std::runtime_error if a line is malformed or names a folder twice.
Floors floorsIn(const std::string& table);

// Returns "path: included: cause" for each include that leads to a folder on the same floor or
// above, or to a folder that the table does not name.
std::vector<std::string> floorViolations(const Floors& floors, const SourceFile& file);

} // namespace patina::architecture
