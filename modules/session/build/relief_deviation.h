// How far a mesh is from the relief that it was made of (F8).
#pragma once

#include "session/build/compile_scene.h"

namespace patina {

struct ReliefDeviation {
  double highest = 0; // [m], |height| of the painted texels
  double rms = 0;     // [m]
  double most = 0;    // [m]
};

// Distances from painted texels, displaced along their faces' normals, to `embossed`; at most some
// 20,000 of them, evenly chosen. All 0 without relief.
ReliefDeviation reliefDeviation(const CompiledScene& compiled, const TriangleMesh& embossed);

} // namespace patina
