// What patina info says of painted scenes; nothing of one that is not painted.
#pragma once

#include <optional>

#include "app/cli/output/report.h"
#include "session/build/compile_scene.h"

namespace patina::cli {

// Bytes of each kind of paint and of what is made of it to be felt.
std::vector<LayerBytes> paintLayers(const CompiledScene& compiled);
// The relief's height and what the scene's device bears of it (F7); nullopt without relief.
const Keys& reliefKeys();
std::optional<Report> reliefReport(const CompiledScene& compiled);

} // namespace patina::cli
