// A calibration that was found becomes a scan's, in the workspace or in its folder. No Qt.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene_scan.h"

namespace patina {

struct Calibration {
  std::string file; // "camera.yml", "rig.json"
  std::shared_ptr<const std::string> text;
  bool tracks = false; // the scan's poses follow from markers
};

// What follows from the calibration goes: it is found anew without it.
SceneScan withCalibration(SceneScan scan, const Calibration& found);
// The same of a folder, where what follows is set aside under its name with ~ behind it. Returns
// the names before that. Throws what says why it could not be written.
std::vector<std::string> calibrateFolder(const std::filesystem::path& folder, const SceneScan& scan,
                                         const Calibration& found);

} // namespace patina
