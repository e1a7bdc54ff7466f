// Options that turn a mesh, workspace or volume into a scene, equal in all commands.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/framework/command.h"
#include "session/compile/compile_scene.h"
#include "session/open/session.h"

namespace patina::cli {

using Settings = std::vector<std::pair<std::string, std::string>>; // scene key, value

struct SceneOptions {
  OpenOptions open;
  Settings settings;
  TextureTable textures{};
};

// Option for a key of the scene, which defines its range, unit and default.
struct SettingEntry {
  std::string key, value, caption;       // "friction.static", "MU", ...
  std::optional<std::string> usual = {}; // if the command's default differs
  std::string option = {};               // if it is not the key's name: "--mass"
};
void addSettings(Command& command, SceneOptions& options, const std::vector<SettingEntry>& entries);
// --unit and --iso.
void addOpenOptions(Command& command, OpenOptions& open);
// --texture.
void addTextureOption(Command& command, TextureTable& textures);
// --resolution --voxel --band.
void addFieldOptions(Command& command, SceneOptions& options);
// The same, --sampler, --unit and --iso.
void addSampledFieldOptions(Command& command, SceneOptions& options);
// --stiffness --damping --friction-... --tip-radius --force-limit.
void addHapticOptions(Command& command, SceneOptions& options);

// Applies all settings or, with an Error, none. Their order matters only for contradictions.
void applySettings(Scene& scene, const Settings& settings);

// Returns true if the settings give a tip radius above zero.
bool setsTipRadius(const Settings& settings);
// Returns the paint.size of the settings, or `before` if they have none.
int paintSizeOf(const Settings& settings, int before);

// Opens a scene, prints warnings and applies the settings. Throws FileError or Error; see
// openScene().
OpenedScene openedWith(const std::filesystem::path& path, const SceneOptions& options,
                       Console& console);
Scene openWith(const std::filesystem::path& path, const SceneOptions& options, Console& console);
// Calls compile() and prints its warnings.
std::shared_ptr<const CompiledScene> compileFor(Scene scene, Console& console,
                                                FaceLayer faces = FaceLayer::on_demand);

} // namespace patina::cli
