// What was found of the open scan, its poses and its path, as files of it.
#pragma once

#include "app/gui/scanning/open_scan.h"

namespace patina {

// What is known of it, as it goes into a scene: as it was read, then what was found since, one
// step after another.
std::vector<SceneScan> foundSteps(const OpenScan& scan);

bool canKeep(const OpenScan& scan); // something was found that its folder does not hold
// poses.tum and path.csv into the folder; throws FileError.
void keepFound(const OpenScan& scan);

} // namespace patina
