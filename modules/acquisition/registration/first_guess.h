// What a path is registered from, where nothing more is known of it.
#pragma once

#include <vector>

#include "acquisition/scan_samples.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// The samples in contact, with `touching` set; all, where none tells a force.
std::vector<PathSample> inContact(std::vector<PathSample> path);
// Leaves out what lies farther than `reach` [m] from the path's middle, the median along each axis:
// no path in contact is longer than what it touches, and one absurd sample would say how long a
// turn of all the others is. Those that were left out.
std::vector<PathSample> leaveOutFar(std::vector<PathSample>& path, double reach);
// The points' middle onto that of the mesh's box. One point or more.
Pose middleOnMiddle(const TriangleMesh& mesh, const std::vector<Vec3>& points);

} // namespace patina
