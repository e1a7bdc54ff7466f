// A scan as its picture draws it.
#pragma once

#include "app/gui/scanning/scan_path.h"
#include "visualization/view/scan_picture.h"

namespace patina {

enum class PathColor { force, sigma, time };
QString captionOf(PathColor color);

// In the mesh's frame where the scan says how the camera saw it, else in the camera's.
Pose pictureFromCamera(const ScanFiles& files);
Vec3 upOf(const ScanFiles& files); // in that frame

DrawnPath drawnPath(const ScanFiles& files, const ScanPath& path, PathColor color);
// Where poses that were left out have the tip.
std::vector<DrawnMark> drawnMarks(const ScanFiles& files, const ScanPath& path);
DrawnCamera drawnCamera(const ScanFiles& files);

} // namespace patina
