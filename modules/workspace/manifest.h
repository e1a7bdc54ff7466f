// workspace.json and the states beside it: what they say, apart from the files that they name.
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

// Read too: 1, without paint and history; 2, whose contact was another (older_values.h); 3, without
// scans, which a scene without scans is still written as.
inline constexpr int kWorkspaceVersion = 4;
inline constexpr const char* kManifestName = "workspace.json";

struct ContentFile {
  std::string path; // relative to the folder, inside it
  std::string sha256;
};

struct ManifestLayout {
  bool made = false;
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
  std::string folder; // of its frames, relative to the workspace and mostly outside; may be empty
  std::string frames;
};

struct ManifestState {
  std::uint64_t event = 0;
  ContentFile file;
};

struct ManifestJournal {
  std::string file;  // relative to the folder
  std::string check; // of the record `event`, or of the heading: tells another journal
};

struct Manifest {
  std::vector<ManifestObject> objects;
  std::vector<ManifestScan> scans;
  Scene values;                           // everything but the objects and scans
  std::uint64_t event = 0;                // how many records of the journal are in it
  std::optional<ManifestJournal> journal; // absent in a state, and in version 1
  std::vector<ManifestState> states;
};

Json toJson(const Manifest& manifest);

// Throws FileError(name): unknown version, a path that leaves the folder, a bad value.
Manifest parseManifest(std::string_view text, const std::string& name);
Manifest readManifest(const std::filesystem::path& folder);

// Every file that the objects and scans need.
std::vector<ContentFile> filesOf(const Manifest& manifest);

} // namespace patina
