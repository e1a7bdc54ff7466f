// What a person should know of a compiled scene that nothing refuses.
#pragma once

#include <string>
#include <vector>

#include "session/build/compile_scene.h"

namespace patina {

// One line each: parts that vanish between the nodes, are felt from where they are not or let go,
// faces of textures that nobody knows, layers too sharp for the device, a magnet
// without range or strength, objects whose poses make the scene larger than any hand reaches.
std::vector<std::string> compileWarnings(const CompiledScene& compiled);

// Of them what says how a mesh was read as a surface: inner triangles that are left out, large
// holes that are closed over, and a surface.sides that no part of it obeys. `mesh`: all of it.
std::vector<std::string> surfaceWarnings(const FieldReport& built, OpenSides sides,
                                         const TriangleMesh& mesh);

} // namespace patina
