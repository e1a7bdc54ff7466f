// Objects and scans of a scene as files of a workspace. Internal to the workspace.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "workspace/manifest.h"

namespace patina {

// All that the scene's objects and scans need is on disk when it returns.
Manifest storeObjects(const Scene& scene, const std::filesystem::path& folder);

// Throws FileError naming the file. With `notes`, paint that cannot be read is left out instead,
// and so are objects without a mesh and scans, with a line for each.
Scene loadScene(const Manifest& manifest, const std::filesystem::path& folder,
                const std::string& name, std::vector<std::string>* notes = nullptr);

} // namespace patina
