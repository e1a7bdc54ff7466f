// Start poses and samples for a registration without prior information.
#pragma once

#include <vector>

#include "acquisition/values/scan_samples.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Returns the samples in contact, with `touching` set; all samples if there is no force.
std::vector<PathSample> inContact(std::vector<PathSample> path);
// Removes and returns the samples farther than `reach` [m] from the componentwise median: no path
// in contact exceeds its object, and a gross outlier would inflate the path's radius.
std::vector<PathSample> removeOutliers(std::vector<PathSample>& path, double reach);
// Returns the pose that moves the points' center to that of the mesh's box. At least one point.
Pose alignCenters(const TriangleMesh& mesh, const std::vector<Vec3>& points);

} // namespace patina
