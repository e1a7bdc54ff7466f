// Scan folders as scans of a scene.
#pragma once

#include "scene/scene_scan.h"

namespace patina {

// What the folder holds of kScanFiles, and which frames. Throws FileError: no folder, nothing of a
// scan in it, a file that cannot be read.
SceneScan scanIn(const std::filesystem::path& folder, const std::string& name);

// SHA-256 over the sorted lines "NAME SIZE" of what lies in the folder; empty: nothing does.
std::string picturesDigest(const std::filesystem::path& folder);
// SHA-256 over names and sizes of the frames and their times' table; empty: there are none. Tells
// another recording or a frame that is missing, not a frame that was retouched to the same size.
std::string framesDigest(const std::filesystem::path& folder);
// Throws FileError in one line: the folder is gone, or has other frames.
void requireFrames(const SceneScan& scan);

} // namespace patina
