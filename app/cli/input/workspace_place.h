// Which folders a command that edits workspaces reads and writes.
#pragma once

#include <filesystem>

namespace patina::cli {

// The folder of a workspace that is there, also by its workspace.json; FileError otherwise.
std::filesystem::path workspaceFolder(const std::filesystem::path& input);
// Whether both are there and one folder.
bool sameFolder(const std::filesystem::path& a, const std::filesystem::path& b);

} // namespace patina::cli
