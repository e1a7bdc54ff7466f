// The scan that is open, with where the desk Align has laid its path.
#pragma once

#include <optional>

#include "app/gui/aligning/align_desk.h"
#include "app/gui/scanning/open_scan.h"
#include "scan/scan_texture.h"
#include "scene/scene.h"

namespace patina {

struct PlacedScan {
  std::string name;
  FilteredScan filtered; // its path only where it touches
  std::vector<CameraPose> poses;
  Rig rig;
  std::vector<PathSample> path; // what of it was placed
  Registration registration;    // on the mesh of the scene's one object; by hand: pose and counts
};

// Throws Error that says what is missing, and where to get it.
PlacedScan placedScan(const OpenScan& scan, const AlignDesk& align, const Scene& scene);

} // namespace patina
