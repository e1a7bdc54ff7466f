#include "app/cli/input/workspace_place.h"

#include "core/error.h"
#include "core/output_target.h"
#include "session/build/session.h"
#include "workspace/workspace.h"

namespace patina::cli {

namespace fs = std::filesystem;

fs::path workspaceFolder(const fs::path& input) {
  const fs::path folder = inputPath(input);
  if (!pathExists(folder)) throw FileError(folder.string(), 0, "no such folder");
  if (!fs::is_directory(folder) || !isWorkspace(folder))
    throw FileError(folder.string(), 0, "is not a workspace; patina scene makes one of a mesh");
  return folder;
}

bool sameFolder(const fs::path& a, const fs::path& b) {
  std::error_code unknown; // of one that is not there
  return fs::equivalent(a, b, unknown);
}

} // namespace patina::cli
