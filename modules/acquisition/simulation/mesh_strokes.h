// Scan paths of a simulated hand over a mesh from above.
#pragma once

#include "acquisition/simulation/simulated_hand.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Returns strokes over the parts of the mesh that are visible along -z and no steeper than 45
// degrees, for a point tip. The surface yields along its normal. Throws Error if they are too
// small.
SimulatedHand scanPathsOver(const TriangleMesh& mesh, std::uint32_t seed, double seconds,
                            double speed);

} // namespace patina
