#include "app/cli/input/scan_input.h"

#include "core/error.h"
#include "scan/track_scan.h"

namespace patina::cli {

std::filesystem::path scanFile(const std::filesystem::path& named, const std::string& option,
                               const std::string& name, const std::string& frames) {
  if (!named.empty()) return named;
  if (const auto folder = scanFolderOf(frames)) return *folder / name;
  if (!frames.starts_with("camera:") && !std::filesystem::exists(frames))
    throw FileError(frames, 0, "does not exist");
  throw Error(option + ": names the file; " + frames + " is no folder that " + name +
              " could be in");
}

} // namespace patina::cli
