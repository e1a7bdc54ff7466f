// Folders of commands that edit workspaces.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "app/cli/framework/console.h"

namespace patina::cli {

// Returns the folder of an existing workspace, also given by its workspace.json; throws FileError.
std::filesystem::path workspaceFolder(const std::filesystem::path& input);
bool sameFolder(const std::filesystem::path& a, const std::filesystem::path& b);

// True, with a warning, if the command's --intent is among the intents of the workspace.
bool isRepeated(const std::filesystem::path& folder, const std::set<std::string>& intents,
                Console& console);
// The same for an output that may be a workspace.
bool isRepeatedIn(const std::filesystem::path& output, Console& console);
// Calls `save` for an edit that is in the journal. It has happened, so a failure is a warning: the
// next opening reads it from the journal.
void saveJournaled(const std::filesystem::path& folder, Console& console,
                   const std::function<void()>& save);

} // namespace patina::cli
