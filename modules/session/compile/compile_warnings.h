// Warnings about a compiled scene that is valid but may not render as intended.
#pragma once

#include <string>
#include <vector>

#include "session/compile/compile_scene.h"

namespace patina {

// One line each: parts that vanish between the nodes, are displaced or let the tip through; faces
// with an unknown texture number; layers too sharp for the device; a magnet without range or
// strength; lengths or poses that exceed the scene or the reach of a hand.
std::vector<std::string> compileWarnings(const CompiledScene& compiled);

// Warnings about the reading of a mesh as a surface: inner triangles that are left out, large holes
// that are closed, and a surface.sides without effect. `mesh`: the whole mesh.
std::vector<std::string> surfaceWarnings(const FieldReport& built, OpenSides sides,
                                         const TriangleMesh& mesh);

} // namespace patina
