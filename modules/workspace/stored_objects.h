// Stores objects and scans of a scene as files of a workspace. Internal to the workspace.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "workspace/manifest.h"

namespace patina {

// All files of the scene's objects and scans are on disk when it returns.
Manifest storeObjects(const Scene& scene, const std::filesystem::path& folder);

// Throws FileError naming the file. With `notes`, unreadable paint, scans and objects without a
// mesh are left out instead, each with a line.
Scene loadScene(const Manifest& manifest, const std::filesystem::path& folder,
                const std::string& name, std::vector<std::string>* notes = nullptr);

} // namespace patina
