#include "app/cli/output/reports.h"

#include <unistd.h>

#include "core/error.h"
#include "core/numbers.h"
#include "core/output_target.h"
#include "scene/scene_values.h"
#include "workspace/manifest.h"
#include "workspace/workspace.h"

namespace patina::cli {

Json vectorJson(const Vec3& v) {
  return Json(Json::Array{v.x(), v.y(), v.z()});
}

const Keys& fieldKeys() {
  static const Keys keys = {
      {"seconds", "s", "built in", "on the wall", Shown::if_any},
      {"cpu_seconds", "s", "of all processors", "", Shown::never},
      {"voxel", "m", "voxel", "", Shown::never},
      {"resolution", "", "grid", "cells along x, y, z"},
      {"origin", "m", "first node", "x, y, z", Shown::never},
      {"band_voxels", "voxels", "band", "on each side"},
      {"blocks", "", "blocks", "", Shown::never},
      {"bytes", "B", "memory"},
      {"dense_bytes", "B", "memory of the whole grid", "", Shown::never},
      {"dropped_triangles", "", "left out", "triangles non-finite or without area", Shown::if_any},
      {"inner_triangles", "", "left out", "triangles that are there twice inside a body",
       Shown::if_any},
      {"ambiguous_signs", "", "unsure", "nodes that may be inside or outside", Shown::if_any},
      {"redistanced_nodes", "", "depths", "nodes re-measured where objects overlap",
       Shown::if_any}};
  return keys;
}

Report fieldReport(const SurfaceField& field, const FieldReport& built) {
  const FieldGrid& grid = field.grid;
  Json resolution = Json::array();
  std::vector<std::string> cells;
  for (const int nodes : grid.nodes) {
    resolution.push(nodes - 1);
    cells.push_back(std::to_string(nodes - 1));
  }
  Report report(fieldKeys());
  report.set("resolution", resolution,
             joined(cells, " x ") + " cells of " + formatLength(grid.voxel));
  report.set("voxel", grid.voxel).set("origin", vectorJson(grid.origin));
  report.set("band_voxels", field.band,
             formatNumber(field.band) + " voxels = " + formatLength(field.band * grid.voxel) +
                 " each side");
  report.set("seconds", built.seconds,
             shown(built.seconds, "s") + ", " + shown(built.cpu_seconds, "s") + " of CPU");
  report.set("cpu_seconds", built.cpu_seconds);
  report.set("blocks", built.blocks);
  report.set("bytes", built.bytes,
             formatBytes(static_cast<double>(built.bytes)) + " in " + formatCount(built.blocks) +
                 " blocks; the whole grid " + formatBytes(static_cast<double>(built.dense_bytes)));
  report.set("dense_bytes", built.dense_bytes);
  report.set("dropped_triangles", built.dropped_triangles,
             formatCount(built.dropped_triangles) + " triangles");
  report.set("inner_triangles", built.inner_triangles,
             formatCount(built.inner_triangles) +
                 " triangles that are there twice, inside the body that the others bound");
  report.set("ambiguous_signs", built.ambiguous_signs,
             formatCount(built.ambiguous_signs) + " nodes may be inside or outside");
  report.set("redistanced_nodes", built.redistanced_nodes,
             formatCount(built.redistanced_nodes) +
                 " nodes re-measured to the union's own surface");
  return report;
}

Json toJson(const Percentiles& p) {
  Json json = Json::object();
  json.set("p50", p.p50).set("p99", p.p99).set("p999", p.p999).set("max", p.max);
  return json;
}

Keys percentileParts() {
  return {{"p50", "", ""}, {"p99", "", ""}, {"p999", "", ""}, {"max", "", ""}};
}

std::string spreadText(const Percentiles& p, const std::string& unit) {
  return rounded(p.p50) + " " + unit + " (p50), " + rounded(p.p99) + " (p99), " + rounded(p.p999) +
         " (p99.9), " + rounded(p.max) + " (max)";
}

namespace {

// "800" of stiffness becomes "800 N/m".
std::string withUnit(const std::string& key, const std::string& value) {
  const std::string_view unit = sceneKey(key).unit;
  if (unit.empty() || !parseNumber(value)) return value;
  return unit == "m" ? formatLength(parseLength(value)) : value + " " + std::string(unit);
}

} // namespace

void tellValues(const Scene& scene, Report& report) {
  Json json = Json::object();
  for (const auto& [key, value] : values(scene)) {
    const auto number = parseNumber(value);
    json.set(key, number ? Json(*number) : Json(value));
    report.tell(key, withUnit(key, value));
  }
  report.set("values", json);
}

const Keys& scanKeys() {
  static const Keys keys = {{"name", "", ""},
                            {"files", "", "", "of its folder that the workspace holds"},
                            {"frames", "", "", "folder of its frames, or empty"}};
  return keys;
}

void tellScans(const Scene& scene, Report& report) {
  if (scene.scans.empty()) return;
  Json list = Json::array();
  for (const SceneScan& scan : scene.scans) {
    Json files = Json::array();
    std::vector<std::string> names;
    for (const auto& [file, text] : scan.files) files.push(file), names.push_back(file);
    list.push(Json::object()
                  .set("name", scan.name)
                  .set("files", std::move(files))
                  .set("frames", scan.folder.string()));
    report.tell("scan " + scan.name,
                joined(names) + (scan.folder.empty() ? "" : "; frames in " + scan.folder.string()));
  }
  report.set("scans", list);
}

std::string historyText(std::size_t undoable, std::size_t redoable) {
  return formatCount(undoable) + " to undo, " + formatCount(redoable) + " to redo";
}

Json jsonOf(const std::vector<std::string>& words) {
  Json list = Json::array();
  for (const std::string& word : words) list.push(word);
  return list;
}

// Returns the workspace that the file is part of; empty for other files, also inside its folder.
static std::filesystem::path workspaceOf(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  if (!fs::exists(file)) return {};
  const fs::path folder = fs::absolute(file).parent_path();
  const std::string name = file.filename().string();
  if ((name == kManifestName || name.starts_with("journal-")) && isWorkspace(folder)) return folder;
  for (const char* part : {"meshes", "paint", "states"})
    if (folder.filename() == part && isWorkspace(folder.parent_path())) return folder.parent_path();
  return {};
}

void requireWritable(const std::filesystem::path& path,
                     const std::vector<std::filesystem::path>& inputs,
                     std::optional<FileKind> kind) {
  const OutputTarget target = outputTarget(path);
  for (const std::filesystem::path& input : inputs) {
    std::error_code unknown; // a missing file is not the same
    if (!target.is_stream && std::filesystem::equivalent(target.path, input, unknown))
      throw FileError(path.string(), 0, "cannot be written: it is an input of this command");
  }
  if (target.is_stream) return;
  const std::filesystem::path end = target.path;
  const std::filesystem::path folder = end.has_parent_path() ? end.parent_path() : ".";
  if (!std::filesystem::is_directory(folder))
    throw FileError(path.string(), 0, "cannot be written: there is no folder " + folder.string());
  if (access(folder.c_str(), W_OK) != 0)
    throw FileError(path.string(), 0, "cannot be written: no permission in " + folder.string());
  if (const std::filesystem::path owner = workspaceOf(end); !owner.empty())
    throw FileError(path.string(), 0,
                    "cannot be written: it belongs to the workspace " + owner.string());
  if (kind) requireSameKind(end, *kind);
}

bool areOne(const std::filesystem::path& a, const std::filesystem::path& b) {
  namespace fs = std::filesystem;
  std::error_code unknown;
  const auto end = [](const fs::path& path) { // resolves links, also to a missing file
    return fs::weakly_canonical(fs::absolute(outputTarget(path).path));
  };
  if (a.empty() || b.empty()) return false;
  return end(a) == end(b) || fs::equivalent(a, b, unknown);
}

} // namespace patina::cli
