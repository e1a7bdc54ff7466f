// Heights that a scan measured along one direction, as heights over the mesh that its path was
// registered to: the body's shape is the mesh's, what is left is texture.
#pragma once

#include "acquisition/profile/scan_heights.h"
#include "acquisition/registration/surface_target.h"
#include "acquisition/scan_samples.h"

namespace patina {

// One of each height whose sample lies in `path` and whose place looks along the heights' normal by
// half or more. `along` is the way over the mesh, from 0 in each stretch; `height` the distance in
// front of the mesh, of the tip's middle less its radius where the target has an offset [m].
// The target is sided. Stretches are numbered anew: beyond samples that were left out another one
// begins. `speed` is that over the mesh, over a fifth of a second. `path`: in the scan's frame, its
// times among those of the heights; both in the order of time.
std::vector<ScanHeight> heightsOverMesh(const SurfaceTarget& target, const Pose& mesh_from_path,
                                        const std::vector<PathSample>& path,
                                        const ScanHeights& heights);

// Of the mesh under a path, in the scan's frame, unit: along which heights over it are measured.
// Each place counts once, however long the
// probe stood there. Throws Error where the path is empty, or the mesh looks to too many sides.
Vec3 meanNormal(const SurfaceTarget& target, const Pose& mesh_from_path,
                const std::vector<PathSample>& path);

// How far the mesh yields where the probe stood and pressed it, along its own normals; absent where
// it never did. The target is sided. `path` touches where it says so, and tells how the tip moved.
std::optional<ComplianceEstimate> complianceOverMesh(const SurfaceTarget& target,
                                                     const Pose& mesh_from_path,
                                                     const std::vector<PathSample>& path);

} // namespace patina
