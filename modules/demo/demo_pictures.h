// The demonstration drawn.
#pragma once

#include <string>
#include <vector>

#include "demo/demo.h"
#include "visualization/layers/path_layer.h"

namespace patina {

// All paths that there are, object frame: where they lie on the toy, coloured by their distance
// from it, once they are registered; before that where the camera saw them, by force.
DrawnPath demoPaths(const Demo& demo);

// Pictures of every step of a demo that is done, into its folder; their names. Throws Error without
// a display.
std::vector<std::string> drawDemo(const Demo& demo);

} // namespace patina
