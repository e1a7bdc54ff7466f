#include "app/cli/input/scan_input.h"

#include "acquisition/files/scan_files.h"
#include "acquisition/registration/first_guess.h"
#include "acquisition/sources/sources.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina::cli {

std::filesystem::path besideFrames(const std::filesystem::path& named, const std::string& option,
                                   const std::string& name, const std::string& frames) {
  if (!named.empty()) return named;
  if (const auto folder = scanFolderOf(frames)) return *folder / name;
  if (!frames.starts_with("camera:") && !std::filesystem::exists(frames))
    throw FileError(frames, 0, "does not exist");
  throw Error(option + ": names the file; " + frames + " is no folder that " + name +
              " could be in");
}

std::vector<PathSample> readTouching(const std::filesystem::path& file, double length,
                                     Console& console) {
  std::vector<std::string> warnings;
  std::vector<PathSample> path = inContact(readPath(file, &warnings));
  for (const std::string& line : warnings) console.warn(line);
  if (const std::vector<PathSample> far = leaveOutFar(path, 2 * length); !far.empty())
    console.warn(file.string() + ": the sample at " + formatNumber(far.front().t) +
                 " s lies farther from the path's middle than the mesh is long, and is left out" +
                 (far.size() > 1 ? ", as are " + formatCount(far.size() - 1) + " more" : ""));
  return path;
}

} // namespace patina::cli
