// One open scene and what is compiled from it: the engines' only meeting place. Used by the command
// line and by the window; knows neither.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "field/build_field.h"
#include "geometry/mesh_report.h"
#include "geometry/mesh_unit.h"
#include "haptics/snapshot.h"
#include "scene/scene.h"

namespace patina {

struct OpenOptions {
  MeshUnit unit = MeshUnit::mm;
  std::optional<double> iso{};    // needed for a volume from elsewhere
  bool unit_chosen = false;       // so that a unit without an effect is warned of
  bool tip_radius_chosen = false; // what is opened gets a tip radius: no advice to set one
};

struct OpenedScene {
  Scene scene;
  std::vector<std::string> warnings; // one line each
};

// What the engines leave out of a mesh, in words: one line a kind, nothing if nothing.
std::vector<std::string> meshWarnings(const MeshReport& report);
// The line that a mesh with edges of one face needs unless the tip has a radius; else nothing.
std::optional<std::string> thinSheetWarning(const MeshReport& report);

// By the extension, in either case: .vti or .VTI.
bool isVolumeFile(const std::filesystem::path& path);
// Such a file that holds a field of ours. Throws FileError if it is a volume but cannot be read.
bool isFieldFile(const std::filesystem::path& path);
// The folder for a workspace.json that is named itself; any other path as it is.
std::filesystem::path inputPath(const std::filesystem::path& path);

// A mesh (.obj .ply .stl), a workspace folder or its workspace.json, a volume (.vti). Throws
// FileError; nothing is kept.
OpenedScene openScene(const std::filesystem::path& path, const OpenOptions& options);

// A mesh in metres as a scene of one object.
Scene sceneOf(TriangleMesh mesh, const std::string& name);

// The scene's objects as one mesh in the world frame.
TriangleMesh worldMesh(const Scene& scene);

// Everything that a scene compiles to. Immutable.
struct CompiledScene {
  Scene scene;
  std::shared_ptr<const TriangleMesh> mesh; // world frame; shared by versions that differ in feel
  MeshReport mesh_report;
  BuiltField built; // with the sample layer
  std::shared_ptr<const HapticSnapshot> snapshot;
};
// Slow; polls progress, throws Cancelled. Safe on a background thread.
std::shared_ptr<const CompiledScene> compile(Scene scene, Progress& progress);
// Only haptic values changed: keeps the field.
std::shared_ptr<const CompiledScene> recompile(const CompiledScene& old,
                                               const HapticProperties& haptics);

} // namespace patina
