// Scan folders taken to a workspace whose mesh has their textures on it, step by step: what
// `patina scan` and the button of the desk Scan run. Each step leaves in a folder the files that
// its command leaves, and what it found in the folder's scan.json.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "geometry/mesh/mesh_unit.h"
#include "scan/register_scans.h"

namespace patina {

// In their order: frames become poses.tum; poses and the probe path.csv; paths registered.csv and
// registration.json; heights heights.csv and texture.json, and these the workspace and
// textured.obj, which is in the first folder.
enum class ScanStep { track, filter, register_paths, texture };
const std::vector<std::string>& scanStepNames(); // "track", "filter", "register", "texture"

struct RunScanOptions {
  std::vector<std::filesystem::path> folders; // one at least; each gives a texture
  std::vector<std::filesystem::path> also;    // that only help to find the place
  std::filesystem::path mesh;
  MeshUnit unit = MeshUnit::mm;
  std::filesystem::path workspace; // to be made; empty where `to` comes before the last step
  // Steps before it are not run. Absent: the first that a folder lacks the files of; paths are
  // registered again where mesh, unit or paths are others than those that were, or where the place
  // was not certain.
  std::optional<ScanStep> from;
  ScanStep to = ScanStep::texture;
  ScanRegistrationOptions registration;
};

struct RunScanReport {
  struct Step {
    ScanStep step = ScanStep::track;
    std::filesystem::path folder;
    std::string found; // in words
    double seconds = 0;
  };
  std::vector<Step> steps; // that ran
  std::vector<std::string> warnings;
  std::optional<RegisteredScans> registered; // where that step ran
  // Whether all were run: without a place that is certain nothing is laid onto the mesh.
  bool done = false;
};

// Throws Error where a folder is named twice or the workspace is there, Error and FileError as the
// steps do, Cancelled. What the steps before have made stays.
RunScanReport runScan(const RunScanOptions& options, Progress& progress);

} // namespace patina
