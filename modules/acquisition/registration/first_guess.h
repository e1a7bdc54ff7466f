// What a path is registered from, where nothing more is known of it.
#pragma once

#include <vector>

#include "acquisition/scan_samples.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// The samples in contact, with `touching` set; all, where none tells a force.
std::vector<PathSample> inContact(std::vector<PathSample> path);
// The points' middle onto that of the mesh's box. One point or more.
Pose middleOnMiddle(const TriangleMesh& mesh, const std::vector<Vec3>& points);

} // namespace patina
