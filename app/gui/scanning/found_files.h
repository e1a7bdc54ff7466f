// Poses and path computed for the open scan, as its files.
#pragma once

#include "app/gui/scanning/open_scan.h"

namespace patina {

// Returns the scan as it was read, then with the results of each further step.
std::vector<SceneScan> foundSteps(const OpenScan& scan);

bool canSaveResults(
    const OpenScan& scan); // True if there are results that its folder does not contain.
// Writes poses.tum and path.csv to the folder. Throws FileError.
void saveResults(const OpenScan& scan);

// Writes a file; one that is there gets a ~ after its name. Returns true if one was there. Throws.
bool writeKeepingOld(const std::filesystem::path& path, const std::string& text);

} // namespace patina
