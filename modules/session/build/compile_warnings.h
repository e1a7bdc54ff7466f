// What a person should know of a compiled scene that nothing refuses.
#pragma once

#include <string>
#include <vector>

#include "session/build/compile_scene.h"

namespace patina {

// Share of the surface [area] that belongs to parts so thin that the field has no inside there.
// Zero where the tip's radius or an offset makes such parts felt.
double vanishedShare(const CompiledScene& compiled);

// One line each: parts that vanish between the nodes, a magnet without range or strength, objects
// whose poses make the scene larger than any hand reaches.
std::vector<std::string> compileWarnings(const CompiledScene& compiled);

} // namespace patina
