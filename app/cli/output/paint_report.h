// What patina info says of painted scenes; nothing of one that is not painted.
#pragma once

#include "app/cli/output/reports.h"
#include "session/build/compile_scene.h"

namespace patina::cli {

// Bytes of each kind of paint and of what is made of it to be felt.
std::vector<LayerBytes> paintLayers(const CompiledScene& compiled);
// The relief's height and what the scene's device bears of it (F7).
void describeRelief(const CompiledScene& compiled, Json& json, TextRows& rows);

} // namespace patina::cli
