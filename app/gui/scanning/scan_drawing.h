// Converts a scan to what its 3D picture draws.
#pragma once

#include "app/gui/scanning/scan_path.h"
#include "visualization/view/scan_picture.h"

namespace patina {

enum class PathColor { force, sigma, time };
QString captionOf(PathColor color);

// Returns the pose in the mesh's frame if the scan contains it, otherwise the identity.
Pose pictureFromCamera(const ScanFiles& files);
Vec3 upOf(const ScanFiles& files); // Up direction in that frame.

DrawnPath drawnPath(const ScanFiles& files, const ScanPath& path, PathColor color);
// Tip positions of rejected poses.
std::vector<DrawnMark> drawnMarks(const ScanFiles& files, const ScanPath& path);
DrawnCamera drawnCamera(const ScanFiles& files);

} // namespace patina
