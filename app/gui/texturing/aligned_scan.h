// The scan that a texture is made of.
#pragma once

#include <string>
#include <vector>

#include "app/gui/aligning/align_desk.h"
#include "app/gui/scanning/open_scan.h"
#include "scan/scan_texture.h"
#include "scene/scene.h"

namespace patina {

// The open scan with the pose that the desk Align has given it.
struct AlignedScan {
  std::string name;
  FilteredScan filtered; // Only samples in contact.
  std::vector<CameraPose> poses;
  Rig rig;
  ScanPlace place; // On the mesh of the scene's one object.
};

// Throws Error that reports what is missing and how to get it.
AlignedScan makeAlignedScan(const OpenScan& scan, const AlignDesk& align, const Scene& scene);

} // namespace patina
