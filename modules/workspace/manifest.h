// workspace.json: what it says, apart from the files that it names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/json.h"
#include "scene/scene.h"

namespace patina {

inline constexpr int kWorkspaceVersion = 1;
inline constexpr const char* kManifestName = "workspace.json";

struct ManifestObject {
  std::string name;
  std::string mesh;   // path relative to the folder, inside it
  std::string sha256; // of the mesh file
  Pose world_from_object = Pose::Identity();
};

struct Manifest {
  std::vector<ManifestObject> objects;
  Scene values; // everything but the objects
};

Json toJson(const Manifest& manifest);

// Throws FileError naming the file: unknown version, a path that leaves the folder, a bad value.
Manifest readManifest(const std::filesystem::path& folder);

} // namespace patina
