#include "app/gui/scanning/scan_files.h"

#include <algorithm>
#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "core/json.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/mesh_unit.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

Pose poseIn(const Json& rows) {
  Eigen::Matrix4d matrix;
  if (rows.asArray().size() != 4) throw Error("'mesh_from_camera' has not four rows");
  for (int i = 0; i < 4; ++i) {
    const Json::Array& row = rows.asArray()[static_cast<std::size_t>(i)].asArray();
    if (row.size() != 4) throw Error("a row of 'mesh_from_camera' has not four numbers");
    for (int k = 0; k < 4; ++k) matrix(i, k) = row[static_cast<std::size_t>(k)].asNumber();
  }
  return Pose(matrix);
}

// Where the mesh is that was scanned, of a scan that was simulated.
void readTruth(const std::filesystem::path& path, ScanFiles& files) try {
  const Json truth = parseJson(readFile(path), path.string());
  if (const Json* rows = truth.find("mesh_from_camera")) files.mesh_from_camera = poseIn(*rows);
  const std::filesystem::path mesh = files.folder / "mesh.obj";
  if (!files.mesh_from_camera || !std::filesystem::exists(mesh)) return;
  const Json* unit = truth.find("mesh_unit");
  const MeshUnit read_in = unit ? parseMeshUnit(unit->asString()) : MeshUnit::mm;
  files.mesh = std::make_shared<const TriangleMesh>(inMetres(readMesh(mesh), read_in).mesh);
} catch (const FileError&) {
  throw;
} catch (const Error& error) {
  throw FileError(path.string(), 0, error.what());
}

// A recording that has seen no marker yet, or heard no probe, has tables without a row.
bool hasRows(const std::filesystem::path& path, int header_lines) {
  std::ifstream file(path);
  int lines = 0;
  for (std::string line; lines <= header_lines && std::getline(file, line);)
    lines += !line.empty() && line[0] != '#';
  return lines > header_lines;
}

} // namespace

bool isScanFolder(const std::filesystem::path& path) {
  std::error_code none; // what cannot be looked at is no scan
  if (!std::filesystem::is_directory(path, none) || isWorkspace(path)) return false;
  const auto has = [&](const char* name) { return std::filesystem::exists(path / name, none); };
  return has("frames.csv") || has("frames") || has("poses.tum") || has("path.csv");
}

ScanFiles readScanFolder(const std::filesystem::path& folder, Progress& progress) {
  ScanFiles files;
  files.folder = folder;
  const auto withFile = [&](const char* name, double fraction, const auto& read) {
    progress.throwIfCancelled();
    progress.report(fraction, name);
    const std::filesystem::path path = folder / name;
    if (std::filesystem::exists(path)) read(path);
  };
  if (std::filesystem::exists(folder / "frames.csv") || std::filesystem::exists(folder / "frames"))
    files.frames = framesOf(folder, 0);
  withFile("camera.yml", 0.1, [&](const auto& path) { files.camera = readCamera(path); });
  withFile("rig.json", 0.15, [&](const auto& path) {
    files.rig = readRig(path);
    const Json json = parseJson(readFile(path), path.string());
    if (json.find("markers") != nullptr && !json.at("markers").asArray().empty())
      files.markers = readMarkers(path);
  });
  withFile("poses.tum", 0.2, [&](const auto& path) {
    if (hasRows(path, 0)) files.poses = readPoses(path).values;
  });
  withFile("path.csv", 0.3, [&](const auto& path) { files.path = readPath(path); });
  withFile("probe.csv", 0.4, [&](const auto& path) {
    if (!hasRows(path, 1)) return;
    files.probe = readProbeStream(path).values;
    if (files.rig)
      for (ProbeSample& sample : files.probe) sample.force = forceOf(*files.rig, sample.force);
  });
  withFile("truth.json", 0.8, [&](const auto& path) { readTruth(path, files); });
  return files;
}

} // namespace patina
