// Relief turned into a mesh of its own (K27).
#pragma once

#include <memory>
#include <span>

#include "authoring/relief/relief_bake.h"

namespace patina {

// The iso-surface of the baked field, closed where the model is. `base` decides the voxel: relief
// finer than some 8 voxels loses height (F8), so build it as fine as the relief needs. Throws Error
// if the relief is higher than the band holds.
TriangleMesh embossed(std::shared_ptr<const SurfaceField> base, const TriangleMesh& mesh,
                      std::span<const ReliefSource> sources, Progress& progress);

} // namespace patina
