// Converts heights along one direction to texture heights over the registered mesh.
#pragma once

#include "acquisition/profile/scan_heights.h"
#include "acquisition/registration/surface_target.h"
#include "acquisition/values/scan_samples.h"

namespace patina {

// Returns a height for each one whose sample is in `path` and whose mesh normal is within 60
// degrees of the heights' normal. `arc_length` is the arc length over the mesh, from 0 in each
// interval; `height` is the distance in front of the mesh, of the tip's center minus its radius if
// the target has an offset [m]. The target has sides. Intervals are numbered again: a sample that
// is left out starts another one. `speed` is measured over the mesh, during a fifth of a second.
// `path` is in the scan's frame and its times are among those of the heights; both are in the order
// of time.
std::vector<ScanHeight> heightsOverMesh(const SurfaceTarget& target, const Pose& mesh_from_path,
                                        const std::vector<PathSample>& path,
                                        const ScanHeights& heights);

// Returns the mean mesh normal under a path, in the scan's frame, unit; heights over the mesh are
// measured along it. Each place counts once, regardless of the probe's speed. Throws Error if the
// path is empty or the normals differ too much.
Vec3 meanNormal(const SurfaceTarget& target, const Pose& mesh_from_path,
                const std::vector<PathSample>& path);

// Estimates the mesh's compliance where the probe was stationary and pressed, along the mesh's
// normals; nullopt without presses. The target has sides. `path` needs `touching`, and gives the
// tip's motion.
std::optional<ComplianceEstimate> complianceOverMesh(const SurfaceTarget& target,
                                                     const Pose& mesh_from_path,
                                                     const std::vector<PathSample>& path);

} // namespace patina
