#include "session/store/attach_scan.h"

#include <algorithm>

#include "core/error.h"
#include "core/file.h"
#include "core/sha256.h"

namespace patina {

namespace fs = std::filesystem;

namespace {

// Sorted lines "NAME SIZE", one per entry of the folder.
std::string namesAndSizes(const fs::path& folder) {
  std::vector<std::string> lines;
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end;
       entry.increment(code)) {
    std::error_code none; // an unreadable entry counts as empty
    const auto size = fs::file_size(entry->path(), none);
    lines.push_back(entry->path().filename().string() + " " + std::to_string(none ? 0 : size) +
                    "\n");
  }
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

} // namespace

SceneScan readScanFiles(const fs::path& folder, const std::string& name) {
  std::error_code code;
  if (!fs::is_directory(folder, code)) throw FileError(folder.string(), 0, "is not a scan folder");
  SceneScan scan;
  scan.name = name;
  for (const ScanFile& file : kScanFiles)
    if (const fs::path path = folder / file.name; fs::exists(path, code))
      scan.files[std::string(file.name)] = std::make_shared<const std::string>(readFile(path));
  scan.frames = framesDigest(folder);
  if (!scan.frames.empty()) scan.folder = fs::absolute(folder).lexically_normal();
  if (scan.files.empty())
    throw FileError(folder.string(), 0,
                    "holds no scan: it has no frames.csv, probe.csv, "
                    "poses.tum or path.csv");
  return scan;
}

std::string picturesDigest(const fs::path& folder) {
  const std::string text = namesAndSizes(folder);
  return text.empty() ? "" : sha256(text);
}

std::string framesDigest(const fs::path& folder) {
  std::string text = namesAndSizes(folder / "frames");
  if (text.empty()) return "";
  std::error_code code;
  const fs::path times = folder / "frames.csv";
  if (fs::exists(times, code)) text += readFile(times);
  return sha256(text);
}

void requireFrames(const SceneScan& scan) {
  if (scan.folder.empty()) return;
  std::error_code code;
  if (!fs::is_directory(scan.folder, code))
    throw FileError(scan.folder.string(), 0,
                    "the folder with the frames of scan '" + scan.name + "' is gone");
  if (framesDigest(scan.folder) != scan.frames)
    throw FileError(scan.folder.string(), 0,
                    "holds other frames than when scan '" + scan.name + "' was attached");
}

} // namespace patina
