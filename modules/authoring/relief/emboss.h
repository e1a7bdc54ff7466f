// Converts relief to a mesh (K27), and measures how far the mesh is from it (F8).
#pragma once

#include <memory>
#include <span>

#include "authoring/relief/relief_bake.h"

namespace patina {

// Returns the iso-surface of the baked field, closed if the model is. `base` determines the voxel:
// relief finer than about 8 voxels loses height (F8). Throws Error if the relief is higher than the
// band.
TriangleMesh embossed(std::shared_ptr<const SurfaceField> base, const TriangleMesh& mesh,
                      std::span<const ReliefInput> sources, Progress& progress);

struct ReliefDeviation {
  double highest = 0; // [m], max |height| of the painted texels
  double rms = 0;     // [m]
  double most = 0;    // [m], max
};

// Distances to `embossed` from at most about 20,000 evenly chosen painted texels of `mesh`,
// displaced along their faces' normals. All 0 without relief.
ReliefDeviation reliefDeviation(const TriangleMesh& mesh, std::span<const ReliefInput> sources,
                                const TriangleMesh& embossed);

} // namespace patina
