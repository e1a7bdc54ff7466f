#include "app/cli/input/workspace_place.h"

#include "core/error.h"
#include "core/output_target.h"
#include "session/open/session.h"
#include "session/store/workspace_storage.h"
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
  std::error_code unknown; // if it does not exist
  return fs::equivalent(a, b, unknown);
}

bool isRepeated(const fs::path& folder, const std::set<std::string>& intents, Console& console) {
  if (!intents.contains(console.intent)) return false;
  console.warn(folder.string() + ": the change of --intent " + console.intent +
               " is in it already; nothing is done");
  return true;
}

bool isRepeatedIn(const fs::path& output, Console& console) {
  return !console.intent.empty() && isWorkspace(output) &&
         isRepeated(output, intentsOf(openHistory(output)), console);
}

void saveJournaled(const fs::path& folder, Console& console, const std::function<void()>& save) {
  try {
    save();
  } catch (const std::exception& error) {
    console.warn(std::string(error.what()) + "; the edit is safe in the journal of " +
                 folder.string() + ", and the next command that changes it saves it");
  }
}

} // namespace patina::cli
