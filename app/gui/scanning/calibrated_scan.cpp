#include "app/gui/scanning/calibrated_scan.h"

#include "core/error.h"
#include "core/file.h"

namespace patina {
namespace {

// What a scan has that follows from the calibration. Poses follow from the camera where markers
// were tracked; a tip is no part of them.
std::vector<std::string> foundAnew(const SceneScan& scan, const Calibration& found) {
  std::vector<std::string> later;
  const bool camera = found.file == "camera.yml";
  if (camera && !found.tracks) return later;
  bool follows = false;
  for (const auto& [name, step] : kScanFiles) {
    follows = follows || name == (camera ? "poses.tum" : "path.csv");
    if (follows && scan.text(std::string(name))) later.emplace_back(name);
  }
  return later;
}

} // namespace

SceneScan withCalibration(SceneScan scan, const Calibration& found) {
  for (const std::string& later : foundAnew(scan, found)) scan.files.erase(later);
  scan.files[found.file] = found.text;
  return scan;
}

std::vector<std::string> calibrateFolder(const std::filesystem::path& folder, const SceneScan& scan,
                                         const Calibration& found) {
  if (folder.empty()) throw Error("the scan is not in the workspace any more, and has no folder");
  writeFileAtomically(folder / found.file, *found.text);
  std::vector<std::string> aside;
  for (const std::string& later : foundAnew(scan, found)) {
    if (!std::filesystem::exists(folder / later)) continue; // the workspace's alone
    std::filesystem::rename(folder / later, folder / (later + "~"));
    aside.push_back(later);
  }
  return aside;
}

} // namespace patina
