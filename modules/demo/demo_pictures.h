// Pictures of the demonstration.
#pragma once

#include <string>
#include <vector>

#include "demo/demo.h"
#include "visualization/layers/path_layer.h"

namespace patina {

// All paths in the object frame: once registered on the toy, coloured by distance; before that in
// the camera's frame, coloured by force.
DrawnPath demoPaths(const Demo& demo);

// Writes pictures of every step of a finished demo into its folder and returns their names. Throws
// Error without a display.
std::vector<std::string> drawDemo(const Demo& demo);

} // namespace patina
