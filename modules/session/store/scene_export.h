// A compiled scene as files that ParaView and image editors open.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/tool_sample.h"
#include "session/build/compile_scene.h"
#include "session/build/surface_stability.h"

namespace patina {

struct ExportExtras {
  std::vector<ToolSample> samples{};              // of a tip that felt the scene
  const SurfaceStability* stability = nullptr;    // as arrays on the surface
  std::vector<std::filesystem::path> inputs{};    // of the export: refused where it would be one
  std::function<void(const std::string&)> warn{}; // what a file cannot hold; absent: nobody hears
};

struct ExportedFile {
  std::string what, name; // "mesh", "mesh.vtp"
};

// The folder is there whole, or as it was before: the mesh, the surface that the tip's centre
// feels, the field, the field at the mesh's vertices, what is painted, the extras, and scene.vtm,
// which opens them together. Throws FileError, Cancelled.
std::vector<ExportedFile> exportScene(const CompiledScene& compiled,
                                      const std::filesystem::path& folder,
                                      const ExportExtras& extras, Progress& progress);

} // namespace patina
