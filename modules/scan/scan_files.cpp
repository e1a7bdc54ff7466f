#include "scan/scan_files.h"

#include <algorithm>

#include "acquisition/files/camera_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json.h"
#include "core/line_buffer.h"
#include "core/output_target.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/pose_file.h"
#include "geometry/mesh/mesh_unit.h"
#include "session/store/attach_scan.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

// Reads the true pose of the mesh in a simulated scan.
void readTruth(const std::string& text, const std::string& name, ScanFiles& files) try {
  const Json truth = parseJson(text, name);
  if (truth.find("mesh_from_camera")) files.mesh_from_camera = poseIn(truth, "mesh_from_camera");
  const std::filesystem::path mesh = files.folder / "mesh.obj";
  if (!files.mesh_from_camera || files.folder.empty() || !std::filesystem::exists(mesh)) return;
  const Json* unit = truth.find("mesh_unit");
  const MeshUnit read_in = unit ? parseMeshUnit(unit->asString()) : MeshUnit::mm;
  files.mesh = std::make_shared<const TriangleMesh>(inMetres(readMesh(mesh), read_in).mesh);
} catch (const FileError&) {
  throw;
} catch (const Error& error) {
  throw FileError(name, 0, error.what());
}

// A recording without a marker or without a probe has tables without rows.
bool hasRows(const std::string& text, int header_lines) {
  LineBuffer file;
  file.append(text);
  int lines = 0;
  for (std::string_view line; lines <= header_lines && file.next(line, true);)
    lines += !line.empty() && line[0] != '#' && line[0] != '%';
  return lines > header_lines;
}

// `where` names the source in errors.
void parseTexts(const std::string& where, ScanFiles& files, Progress& progress) {
  const auto withFile = [&](const char* name, double fraction, const auto& parse) {
    progress.throwIfCancelled();
    progress.report(fraction, name);
    if (const std::string* text = files.scan.text(name)) parse(*text, where + name);
  };
  withFile("camera.yml", 0.1, [&](const std::string& text, const std::string& name) {
    files.camera = parseCamera(text, name);
  });
  withFile("rig.json", 0.15, [&](const std::string& text, const std::string& name) {
    files.rig = parseRig(text, name);
    const Json json = parseJson(text, name);
    if (json.find("markers") != nullptr && !json.at("markers").asArray().empty())
      files.markers = parseMarkers(text, name);
  });
  withFile("poses.tum", 0.2, [&](const std::string& text, const std::string& name) {
    if (hasRows(text, 0)) files.poses = parsePoses(text, name, {}, &files.warnings).values;
  });
  withFile("path.csv", 0.3, [&](const std::string& text, const std::string& name) {
    files.path = parsePath(text, name, &files.warnings);
  });
  withFile("probe.csv", 0.4, [&](const std::string& text, const std::string& name) {
    if (!hasRows(text, 1)) return;
    files.probe = parseProbeStream(text, name, &files.warnings, &files.rates).values;
    if (files.rig)
      for (ProbeSample& sample : files.probe) sample.force = forceOf(*files.rig, sample.force);
  });
  withFile("truth.json", 0.8,
           [&](const std::string& text, const std::string& name) { readTruth(text, name, files); });
}

} // namespace

bool isScanFolder(const std::filesystem::path& path) {
  std::error_code none; // an unreadable folder is not a scan
  if (!std::filesystem::is_directory(path, none) || isWorkspace(path)) return false;
  const auto has = [&](const char* name) { return std::filesystem::exists(path / name, none); };
  return has("frames.csv") || has("frames") || has("poses.tum") || has("path.csv");
}

ScanFiles readScanFolder(const std::filesystem::path& folder, Progress& progress) {
  ScanFiles files;
  files.scan = readScanFiles(folder, scanNameOf(folder));
  files.folder = folder;
  if (std::filesystem::exists(folder / "frames.csv") || std::filesystem::exists(folder / "frames"))
    files.frames = framesOf(folder, 0);
  parseTexts((folder / "").string(), files, progress);
  return files;
}

ScanFiles readScan(const SceneScan& scan, Progress& progress) {
  ScanFiles files;
  files.of_scene = true;
  files.scan = scan;
  try {
    requireFrames(scan);
    files.folder = scan.folder;
    if (!scan.folder.empty()) files.frames = framesOf(scan.folder, 0);
  } catch (const FileError& error) {
    files.folder.clear();
    files.problem = error.what();
  }
  parseTexts("scan '" + scan.name + "': ", files, progress);
  return files;
}

double tipRadiusOf(const std::vector<std::filesystem::path>& folders) {
  std::optional<double> radius;
  std::filesystem::path first;
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path file = folder / "rig.json";
    if (!pathExists(file)) continue;
    const double own = readRig(file).tip_radius;
    if (radius && own != *radius)
      throw FileError(file.string(), 0,
                      "has another 'tip_radius' than " + first.string() +
                          ": name one for all, --tip-radius");
    radius = own;
    first = file;
  }
  return radius.value_or(0);
}

} // namespace patina
