// What one call of patina scene changes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/input/scene_options.h"
#include "scene/edit.h"

namespace patina::cli {

struct SceneEdits {
  std::vector<std::string> added;   // MESH[@POSE.txt]
  std::vector<std::string> moved;   // NAME@POSE.txt
  std::vector<std::string> removed; // NAME
  std::vector<std::string> images;  // OBJECT=FILE[,color|relief][,mapped|x|y|z]
  std::vector<std::string> scans;   // DIR[@NAME]
  std::vector<std::string> unscans; // NAME
  TextureTable textures{};
  Settings settings;

  bool empty() const {
    return added.empty() && moved.empty() && removed.empty() && images.empty() && scans.empty() &&
           unscans.empty() && textures.empty() && settings.empty();
  }
};

// The files that one of these texts names: FilesIn of its option.
std::vector<std::filesystem::path> filesToAdd(const std::string& added);
std::vector<std::filesystem::path> fileToMoveBy(const std::string& moved);
std::vector<std::filesystem::path> folderOfScan(const std::string& scan);
std::vector<std::filesystem::path> fileOfImage(const std::string& image);

// Removals first, then moves, additions, textures, settings, images. Throws Error; `scene` is only
// read.
Scene edited(const Scene& scene, const SceneEdits& edits, const OpenOptions& open,
             Console& console);
// The one record of all of it; `after` is what edited() gave of `before`.
Edit editOf(const SceneEdits& edits, const Scene& before, const Scene& after);

} // namespace patina::cli
