// Exports a compiled scene as files for ParaView and image editors.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/tool_sample.h"
#include "session/compile/compile_scene.h"
#include "session/open/surface_stability.h"

namespace patina {

struct ExportExtras {
  std::vector<ToolSample> samples{};           // tool path over the scene
  const SurfaceStability* stability = nullptr; // written as arrays on the surface
  std::vector<std::filesystem::path> inputs{}; // input files, which the export must not overwrite
  // called for data that a file cannot hold; may be empty
  std::function<void(const std::string&)> warn{};
};

struct ExportedFile {
  std::string what, name; // "mesh", "mesh.vtp"
};

// Writes all files or leaves the folder unchanged: the mesh, the offset surface that the tip's
// centre touches, the field, the field at the mesh's vertices, the paint, the extras, and
// scene.vtm, which opens them together. Throws FileError, Cancelled.
std::vector<ExportedFile> exportScene(const CompiledScene& compiled,
                                      const std::filesystem::path& folder,
                                      const ExportExtras& extras, Progress& progress);

} // namespace patina
