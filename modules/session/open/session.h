// Opens a scene. Together with compile_scene.h it is the only place that joins the engines; the
// command line and the window use it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/mesh_unit.h"
#include "scene/scene.h"
#include "session/compile/compile_scene.h"

namespace patina {

struct OpenOptions {
  MeshUnit unit = MeshUnit::mm;
  UpAxis up = UpAxis::z;               // only for a mesh file
  std::optional<double> iso{};         // required for a volume from another program
  bool unit_chosen = false;            // warn if the unit has no effect
  int paint_size = Scene{}.paint_size; // min texels per side for the colours of a mesh file
  bool tip_radius_chosen = false;      // a tip radius will be set: no advice to set one
};

struct StoredHistory {
  std::size_t undoable = 0, redoable = 0; // edits
};

struct OpenedScene {
  Scene scene;                          // a workspace includes journaled edits that were not saved
  std::vector<std::string> warnings;    // one line each
  std::optional<StoredHistory> history; // only for a workspace
};

// Describes mesh elements that the engines leave out: one line per kind, or none.
std::vector<std::string> meshWarnings(const MeshReport& report);
// Warning for a mesh with boundary edges if the tip has no radius.
std::optional<std::string> thinSheetWarning(const MeshReport& report);
// Warning for an object whose own texture coordinates cannot hold its paint.
std::optional<std::string> layoutWarning(const SceneObject& object);

// Decides by the extension, in either case: .vti or .VTI.
bool isVolumeFile(const std::filesystem::path& path);
// Returns true for a volume file that holds a Patina field. Throws FileError if it is unreadable.
bool isFieldFile(const std::filesystem::path& path);
// Returns the folder for a path to workspace.json, and any other path unchanged.
std::filesystem::path inputPath(const std::filesystem::path& path);

// Opens a mesh (.obj .ply .stl), a workspace folder or its workspace.json, or a volume (.vti).
// Throws FileError; writes nothing. Slow for a workspace with unsaved strokes: they are replayed.
OpenedScene openScene(const std::filesystem::path& path, const OpenOptions& options);

// key: texture number
using TextureTable = std::map<std::int32_t, std::shared_ptr<const HapticTexture>>;

// Adds each texture to the library of every object that has faces with its number (A17).
// Throws Error for a number without faces.
void layTextures(Scene& scene, const TextureTable& textures);

// Makes a scene of one object from a mesh in metres.
Scene sceneOf(TriangleMesh mesh, const std::string& name);

} // namespace patina
