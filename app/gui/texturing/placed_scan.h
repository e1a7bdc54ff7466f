// The scan that is open, with where the desk Align has laid its path.
#pragma once

#include <optional>

#include "app/gui/aligning/align_desk.h"
#include "app/gui/scanning/open_scan.h"
#include "scan/scan_steps.h"
#include "scene/scene.h"

namespace patina {

struct PlacedScan {
  std::string name;
  FilteredScan filtered; // its path only where it touches
  std::vector<CameraPose> poses;
  ProbeModel probe;
  Vec3 gravity = Vec3::Zero();            // in the camera's frame [m/s^2]
  Pose mesh_from_scan = Pose::Identity(); // mesh: of the scene's one object
  // The surface's compliance that the registration found [m/N]; nullopt if the path was placed by
  // hand, so that no registration has estimated it.
  std::optional<double> compliance;
};

// Throws Error that says what is missing, and where to get it.
PlacedScan placedScan(const OpenScan& scan, const AlignDesk& align, const Scene& scene);

} // namespace patina
