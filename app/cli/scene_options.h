// The options with which a mesh, workspace or volume becomes a scene; the same words in every
// command.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/command.h"
#include "app/session.h"

namespace patina::cli {

struct SceneOptions {
  OpenOptions open;
  std::vector<std::pair<std::string, std::string>> settings; // scene key, value
};

// --unit and --iso.
void addOpenOptions(Command& command, OpenOptions& open);
// --resolution --voxel --band; and --sampler.
void addFieldOptions(Command& command, SceneOptions& options);
void addSamplerOption(Command& command, SceneOptions& options);
// --stiffness --damping --friction-... --tip-radius --force-limit.
void addHapticOptions(Command& command, SceneOptions& options);

// Opens, warns, and applies the settings. Throws FileError or Error; see openScene().
Scene openWith(const std::filesystem::path& path, const SceneOptions& options, Console& console);

} // namespace patina::cli
