// Models made by means of a field.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// A toy dinosaur, 100 mm long: a smooth union of capsules meshed by its iso-surface; closed, about
// 70,000 triangles at the default resolution.
TriangleMesh dinosaur(int resolution = 200);

} // namespace patina
