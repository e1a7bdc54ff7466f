// Contents of workspace.json and of state files, without the files that they name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.h"
#include "scene/scene.h"

namespace patina {

// Older versions are read: 1 has no paint and no history; 2 has another contact law
// (migrations.h); 3 has no scans. A scene without scans is still written as version 3.
inline constexpr int kWorkspaceVersion = 4;
inline constexpr const char* kManifestName = "workspace.json";

struct ContentFile {
  std::string path; // relative to the folder, inside it
  std::string sha256;
};

struct ManifestLayout {
  bool generated = false;
  int charts = 0;
  std::optional<ContentFile> file; // absent: the mesh's own texture coordinates
};

struct ManifestPaint {
  std::optional<ManifestLayout> layout;
  std::optional<ContentFile> color, relief, material, textures;
};

struct ManifestObject {
  std::string name;
  ContentFile mesh;
  Pose world_from_object = Pose::Identity();
  std::optional<ManifestPaint> paint;
};

struct ManifestScan {
  std::string name;
  std::map<std::string, ContentFile> files;
  std::string folder; // frames, relative to the workspace and usually outside it; may be empty
  std::string frames;
};

struct ManifestState {
  std::uint64_t event = 0;
  ContentFile file;
};

struct ManifestJournal {
  std::string file;     // relative to the folder
  std::string checksum; // checksum of record `event` or of the header; detects another journal
};

struct Manifest {
  std::vector<ManifestObject> objects;
  std::vector<ManifestScan> scans;
  Scene values;                           // everything but the objects and scans
  std::uint64_t event = 0;                // number of journal records that the scene includes
  std::optional<ManifestJournal> journal; // absent in a state, and in version 1
  std::vector<ManifestState> states;
};

Json toJson(const Manifest& manifest);

// Throws FileError(name): unknown version, a path that leaves the folder, a bad value.
Manifest parseManifest(std::string_view text, const std::string& name);
Manifest readManifest(const std::filesystem::path& folder);

std::vector<ContentFile> filesOf(const Manifest& manifest);

} // namespace patina
