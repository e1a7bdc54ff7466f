// A scene as a folder that opens again (DESIGN section 8).
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace patina {

// workspace.json (version 1, relative paths, SHA-256 of each file) and meshes/NAME.ply.
// Throws FileError naming file and cause: unknown version, wrong hash, a path that leaves the
// folder.
Scene loadWorkspace(const std::filesystem::path& folder);

// Atomic: at any moment the folder holds the old workspace or the new one, whole.
void saveWorkspace(const Scene& scene, const std::filesystem::path& folder);

bool isWorkspace(const std::filesystem::path& path);

} // namespace patina
