// Strokes from a file: what patina paint replays.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/output/console.h"
#include "scene/stroke.h"

namespace patina::cli {

struct ScriptStroke {
  Stroke stroke;
  std::string where; // "hand.json: stroke 3"
};

// A strokes file (version 1) or, by the extension .jsonl, the journal of a workspace: the strokes
// that stand at its end; its other edits are left out with a warning. Throws FileError.
std::vector<ScriptStroke> readScript(const std::filesystem::path& path, Console& console);

} // namespace patina::cli
