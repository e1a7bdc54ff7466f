// Components that run through a hole of the surface: private to signs.
#pragma once

#include <cstdint>
#include <vector>

#include "field/signs/sign_components.h"
#include "geometry/mesh/open_parts.h"

namespace patina::signs {

// Of the faces that are not open: no edge, vertices at equal positions being one and coincident
// faces too, has a single face: no component can run from inside to outside, whichever way the
// faces are turned.
bool isClosed(const TriangleMesh& mesh, const OpenParts& open);

// A cut of leaking components that follows the parts' opinions (1 = surely inside, -1 = surely
// outside, 0 = none; NaN = not of a leaking component) and crosses few edges: a random walk from
// each part along the links ends at the opinion that it meets first. Returns the sign of phi by
// part: -1 inside, +1 outside, 0 for parts of other components.
std::vector<std::int8_t> cutLeaks(const Components& components, const std::vector<float>& opinion);

} // namespace patina::signs
