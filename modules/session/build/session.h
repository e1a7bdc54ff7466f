// Opening a scene; together with compile_scene.h the engines' only meeting place. Used by the
// command line and by the window; knows neither.
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
#include "session/build/compile_scene.h"

namespace patina {

struct OpenOptions {
  MeshUnit unit = MeshUnit::mm;
  UpAxis up = UpAxis::z;               // of a mesh file
  std::optional<double> iso{};         // needed for a volume from elsewhere
  bool unit_chosen = false;            // so that a unit without an effect is warned of
  int paint_size = Scene{}.paint_size; // least texels a side of the colours of a mesh file
  bool tip_radius_chosen = false;      // what is opened gets a tip radius: no advice to set one
};

struct StoredHistory {
  std::size_t undoable = 0, redoable = 0; // edits
};

struct OpenedScene {
  Scene scene;                          // of a workspace: as its journal leaves it, saved or not
  std::vector<std::string> warnings;    // one line each
  std::optional<StoredHistory> history; // of a workspace
};

// What the engines leave out of a mesh, in words: one line a kind, nothing if nothing.
std::vector<std::string> meshWarnings(const MeshReport& report);
// The line that a mesh with edges of one face needs unless the tip has a radius; else nothing.
std::optional<std::string> thinSheetWarning(const MeshReport& report);
// The line for an object whose own texture coordinates cannot hold its paint; else nothing.
std::optional<std::string> layoutWarning(const SceneObject& object);

// By the extension, in either case: .vti or .VTI.
bool isVolumeFile(const std::filesystem::path& path);
// Such a file that holds a field of ours. Throws FileError if it is a volume but cannot be read.
bool isFieldFile(const std::filesystem::path& path);
// The folder for a workspace.json that is named itself; any other path as it is.
std::filesystem::path inputPath(const std::filesystem::path& path);

// A mesh (.obj .ply .stl), a workspace folder or its workspace.json, a volume (.vti). Throws
// FileError; nothing is kept and nothing written. Slow for a workspace that was not saved after its
// last strokes: they are painted anew.
OpenedScene openScene(const std::filesystem::path& path, const OpenOptions& options);

using TextureTable = std::map<std::int32_t, std::shared_ptr<const FeltTexture>>; // by number

// Each takes its place in the library of every object that has faces of that number (A17). Throws
// Error for a number that no face has.
void layTextures(Scene& scene, const TextureTable& textures);

// A mesh in metres as a scene of one object.
Scene sceneOf(TriangleMesh mesh, const std::string& name);

} // namespace patina
