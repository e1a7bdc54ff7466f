// A hand that scans a mesh from above, where its surface can be drawn over.
#pragma once

#include "acquisition/simulation/simulated_hand.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Strokes over what of the mesh is seen along -z and no steeper than 45 degrees; the tip is a
// point. Throws Error where that is too little.
SimulatedHand strokesOver(const TriangleMesh& mesh, std::uint32_t seed, double seconds,
                          double speed);

} // namespace patina
