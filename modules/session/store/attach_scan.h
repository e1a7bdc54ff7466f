// Attaches scan folders to a scene.
#pragma once

#include "scene/scene_scan.h"

namespace patina {

// Reads which of kScanFiles and which frames the folder holds. Throws FileError: no folder, no scan
// in it, an unreadable file.
SceneScan readScanFiles(const std::filesystem::path& folder, const std::string& name);

// SHA-256 over the sorted lines "NAME SIZE" of the folder's entries; "" for an empty folder.
std::string picturesDigest(const std::filesystem::path& folder);
// SHA-256 over names and sizes of the frames and of their table of times; "" without frames.
// Detects another recording or a missing frame, but no frame edited at the same size.
std::string framesDigest(const std::filesystem::path& folder);
// Throws FileError with one line if the folder is missing or has other frames.
void requireFrames(const SceneScan& scan);

} // namespace patina
