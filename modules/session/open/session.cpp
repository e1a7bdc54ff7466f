#include "session/open/session.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "authoring/images/apply_colors.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/output_target.h"
#include "core/utf8.h"
#include "field/surface/iso_surface.h"
#include "geometry/io/textured_obj.h"
#include "session/store/journal_fold.h"
#include "session/store/replay.h"
#include "session/store/workspace_storage.h"
#include "visualization/files/field_io.h"
#include "workspace/manifest.h"
#include "workspace/workspace.h"

namespace patina {

namespace {

constexpr const char* kReadable =
    "what can be opened: a mesh (.obj, .ply, .stl), a volume (.vti), a workspace (a folder with "
    "workspace.json) and, into a workspace, a scan (a folder with frames.csv)";

std::string lowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// Returns a name that scene.h accepts for an object.
std::string objectName(const std::filesystem::path& path) {
  std::string name = path.stem().string();
  for (char& c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (letter < 128 && !std::isalnum(letter) && c != '-' && c != '_') c = '_';
  }
  if (!isUtf8(name)) // file names may have another encoding, which cannot be saved
    for (char& c : name)
      if (static_cast<unsigned char>(c) >= 128) c = '_';
  return name.empty() || isStandardStream(path) ? "object" : name;
}

// Surface of a volume; for a Patina field, in metres, also its resolution.
struct VolumeSurface {
  TriangleMesh mesh;
  std::optional<FieldSpec> spec{};
};

VolumeSurface surfaceOfVolume(const std::filesystem::path& path, const OpenOptions& options) {
  if (isField(path)) {
    const SurfaceField field = readField(path);
    const double iso = options.iso.value_or(0.0), band = field.band * field.grid.voxel;
    if (!(std::abs(iso) < band))
      throw FileError(path.string(), 0,
                      "--iso " + formatNumber(iso) + ": the field holds distances between " +
                          formatNumber(-band) + " and " + formatNumber(band) + " m");
    FieldSpec spec;
    spec.voxel = field.grid.voxel;
    spec.band = field.band;
    return {isoSurface(field, iso), spec};
  }
  if (!options.iso) {
    const VolumeRange range = scalarRange(path);
    throw FileError(path.string(), 0,
                    "a volume is felt as an iso-surface: choose its value with --iso, between " +
                        formatNumber(range.low) + " and " + formatNumber(range.high));
  }
  return {isoSurfaceOfVolume(path, *options.iso)};
}

} // namespace

std::vector<std::string> meshWarnings(const MeshReport& report) {
  std::vector<std::string> lines;
  const auto count = [](std::size_t n, const char* what) {
    return formatCount(n) + (n == 1 ? " triangle " : " triangles ") + what;
  };
  if (report.non_finite)
    lines.push_back(count(report.non_finite, "with a NaN or infinite corner: left out"));
  if (report.degenerate) lines.push_back(count(report.degenerate, "without area: left out"));
  return lines;
}

std::optional<std::string> thinSheetWarning(const MeshReport& report) {
  if (report.boundary_edges == 0) return std::nullopt;
  return formatCount(report.boundary_edges) + (report.boundary_edges == 1 ? " edge" : " edges") +
         " of one triangle: a part that stays open is felt from its front "
         "(patina info, sides); from both sides with patina scene --set surface.sides=two "
         "--set tip.radius=1mm";
}

std::optional<std::string> layoutWarning(const SceneObject& object) {
  const bool has_images = object.paint && object.paint->layout.uvs;
  if (object.mesh->corner_uvs.empty() || has_images) return std::nullopt;
  const std::string fault = ownLayoutFault(*object.mesh);
  if (fault.empty()) return std::nullopt;
  return fault + ": paint gets an atlas of its own; pictures still use the mesh's "
                 "coordinates";
}

namespace {

void addLayoutWarning(OpenedScene& opened, const std::string& where, const SceneObject& object) {
  if (const auto line = layoutWarning(object)) opened.warnings.push_back(where + ": " + *line);
}

void addWarnings(OpenedScene& opened, const std::string& where, const TriangleMesh& mesh,
                 bool chosen) {
  const MeshReport report = inspect(mesh);
  if (report.non_finite + report.degenerate == report.triangles)
    throw FileError(where, 0,
                    "it has no usable triangle: " + formatCount(report.non_finite) +
                        " with a NaN or infinite corner, " + formatCount(report.degenerate) +
                        " without area");
  for (const std::string& line : meshWarnings(report))
    opened.warnings.push_back(where + ": " + line);
  const auto thin = thinSheetWarning(report);
  if (thin && !chosen) opened.warnings.push_back(where + ": " + *thin);
}

bool isScan(const std::filesystem::path& folder) {
  std::error_code none;
  return std::filesystem::exists(folder / "frames.csv", none) ||
         std::filesystem::exists(folder / "frames", none);
}

void openFolder(const std::filesystem::path& folder, OpenedScene& opened) {
  OpenedWorkspace found = openWorkspace(folder);
  const FoldedJournal fold = folded(found.journal, found.journal_file.string());
  opened.history = {fold.position, fold.steps.size() - fold.position};
  for (const std::string& note : found.notes) opened.warnings.push_back(note);
  if (found.event >= found.journal.size()) {
    opened.scene = std::move(found.scene);
    return;
  }
  opened.scene =
      WorkspaceStorage::open(folder, Replayer(), kHistoryBudget, false, false).history->scene();
}

} // namespace

namespace {

// Throws a FileError that names every kind of file that can be opened.
void requireReadable(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 8> kClouds = {".xyz", ".pts", ".pcd", ".las",
                                                       ".laz", ".e57", ".asc", ".ptx"};
  const std::string extension = lowerExtension(path);
  if (isStandardStream(path) || path.string().starts_with("/dev/") || extension == ".ply" ||
      extension == ".stl")
    return;
  const bool cloud = std::find(kClouds.begin(), kClouds.end(), extension) != kClouds.end();
  throw FileError(path.string(), 0,
                  (cloud ? "a point cloud ('" + extension +
                               "') has no surface: make a mesh of it with a surface "
                               "reconstruction; "
                   : extension.empty()
                       ? std::string("a file without an extension cannot be read;  ")
                       : "a file of the kind '" + extension + "' cannot be read; ") +
                      kReadable);
}

std::shared_ptr<const ObjectPaint> withTextures(const ObjectPaint* before,
                                                std::vector<TexturedFace> faces) {
  ObjectPaint paint = before ? *before : ObjectPaint{};
  paint.textures = std::make_shared<const TextureMappings>(TextureMappings{std::move(faces), {}});
  return std::make_shared<const ObjectPaint>(std::move(paint));
}

} // namespace

bool isVolumeFile(const std::filesystem::path& path) {
  return lowerExtension(path) == ".vti";
}

bool isFieldFile(const std::filesystem::path& path) {
  return isVolumeFile(path) && isField(path);
}

std::filesystem::path inputPath(const std::filesystem::path& path) {
  if (path.filename() != kManifestName || std::filesystem::is_directory(path)) return path;
  return path.has_parent_path() ? path.parent_path() : ".";
}

OpenedScene openScene(const std::filesystem::path& input, const OpenOptions& options) {
  const std::filesystem::path path = inputPath(input);
  if (!isStandardStream(path) && !pathExists(path))
    throw FileError(path.string(), 0, "no such file or folder");
  OpenedScene opened;
  const auto warnOf = [&](const char* option, const char* what) {
    opened.warnings.push_back(path.string() + ": " + option + " has no effect on a " + what);
  };
  if (std::filesystem::is_directory(path)) {
    if (!isWorkspace(path))
      throw FileError(path.string(), 0,
                      isScan(path)
                          ? "is the folder of a scan: put it into a workspace with patina scene "
                            "-o WORKSPACE --scan " +
                                path.string()
                          : std::string("is a folder without workspace.json, not a workspace; ") +
                                kReadable);
    openFolder(path, opened);
    if (options.unit_chosen) warnOf("--unit", "workspace");
    if (options.up != UpAxis::z) warnOf("--up", "workspace");
    if (options.iso) warnOf("--iso", "workspace");
    const bool chosen = opened.scene.field.sides != OpenSides::automatic ||
                        options.tip_radius_chosen ||
                        opened.scene.haptics.tip_radius.value_or(0.0) > 0;
    for (const SceneObject& object : opened.scene.objects) {
      const std::string where = path.string() + ": " + object.name;
      addWarnings(opened, where, *object.mesh, chosen);
      addLayoutWarning(opened, where, object);
    }
    return opened;
  }
  const bool is_volume = isVolumeFile(path);
  TexturedMesh read;
  MeshColors colors;
  std::optional<FieldSpec> spec;
  if (is_volume) {
    VolumeSurface volume = surfaceOfVolume(path, options);
    read.mesh = std::move(volume.mesh);
    spec = volume.spec;
  } else if (lowerExtension(path) == ".obj") {
    read = readTexturedObj(path, &colors);
  } else {
    requireReadable(path);
    read.mesh = readMesh(path, &read.warnings, &colors);
  }
  for (const std::string& line : read.warnings)
    opened.warnings.push_back(path.string() + ": " + line);
  const bool in_metres = spec.has_value();
  TriangleMesh mesh = is_volume ? std::move(read.mesh) : zUp(std::move(read.mesh), options.up);
  if (options.unit_chosen && in_metres) warnOf("--unit", "field");
  if (options.iso && !is_volume) warnOf("--iso", "mesh");
  if (options.up != UpAxis::z && is_volume) warnOf("--up", "volume");
  if (mesh.triangles.empty()) throw FileError(path.string(), 0, "there is no triangle in it");
  addWarnings(opened, path.string(), mesh, options.tip_radius_chosen);
  ScaledMesh scaled;
  try {
    scaled = inMetres(std::move(mesh), in_metres ? MeshUnit::m : options.unit);
  } catch (const Error& error) {
    throw FileError(path.string(), 0, error.what());
  }
  if (!scaled.warning.empty()) opened.warnings.push_back(path.string() + ": " + scaled.warning);
  opened.scene = sceneOf(std::move(scaled.mesh), objectName(path));
  addLayoutWarning(opened, path.string(), opened.scene.objects[0]);
  if (spec) opened.scene.field = *spec;
  for (TexturedFace& face : read.textured)
    for (Vec2& at : face.coords) at *= scaled.scale;
  std::vector<std::string> warnings;
  SceneObject& object = opened.scene.objects[0];
  object.paint = paintOf(*object.mesh, colors, options.paint_size, warnings);
  for (const std::string& line : warnings) opened.warnings.push_back(path.string() + ": " + line);
  if (!read.textured.empty())
    object.paint = withTextures(object.paint.get(), std::move(read.textured));
  return opened;
}

void layTextures(Scene& scene, const TextureTable& textures) {
  for (const auto& [number, texture] : textures) {
    bool lies = false;
    for (SceneObject& object : scene.objects) {
      if (!object.paint || !object.paint->textures) continue;
      const TextureMappings& laid = *object.paint->textures;
      if (std::none_of(laid.faces.begin(), laid.faces.end(),
                       [&](const TexturedFace& face) { return face.texture == number; }))
        continue;
      lies = true;
      TextureMappings changed = laid;
      changed.library[number] = texture;
      ObjectPaint paint = *object.paint;
      paint.textures = std::make_shared<const TextureMappings>(std::move(changed));
      object.paint = std::make_shared<const ObjectPaint>(std::move(paint));
    }
    if (!lies)
      throw Error("texture " + std::to_string(number) +
                  ": no face has it; patina map-texture lays one onto a mesh");
  }
}

Scene sceneOf(TriangleMesh mesh, const std::string& name) {
  Scene scene;
  SceneObject& object = scene.objects.emplace_back();
  object.name = name;
  object.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  return scene;
}

} // namespace patina
