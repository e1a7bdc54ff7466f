// The options with which a mesh, workspace or volume becomes a scene; the same words in every
// command.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands/command.h"
#include "session/build/compile_scene.h"
#include "session/build/session.h"

namespace patina::cli {

using Settings = std::vector<std::pair<std::string, std::string>>; // scene key, value

struct SceneOptions {
  OpenOptions open;
  Settings settings;
  TextureTable textures{};
};

// An option that stands for a key of the scene: the scene says what is allowed, in which unit, and
// what holds without it.
struct SettingEntry {
  std::string key, value, caption;       // "friction.static", "MU", ...
  std::optional<std::string> usual = {}; // where the command's differs from the scene's
  std::string option = {};               // where it is not the key's name: "--mass"
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

// All of them or, with an Error, none. Their order matters only where they contradict one another.
void applySettings(Scene& scene, const Settings& settings);

// Whether they leave a scene with a tip radius above zero.
bool setsTipRadius(const Settings& settings);
// Returns the paint.size that the settings leave; `before` where they do not name it.
int paintSizeOf(const Settings& settings, int before);

// Opens, warns, and applies the settings. Throws FileError or Error; see openScene().
OpenedScene openedWith(const std::filesystem::path& path, const SceneOptions& options,
                       Console& console);
Scene openWith(const std::filesystem::path& path, const SceneOptions& options, Console& console);
// compile(), with what should be known of the result as warnings.
std::shared_ptr<const CompiledScene> compileFor(Scene scene, Console& console,
                                                FaceLayer faces = FaceLayer::if_read);

} // namespace patina::cli
