// Runs the steps from scan folders to a workspace with a textured mesh, for `patina scan` and the
// button of the Scan page. Each step writes the files of its own command, and its result to the
// folder's scan.json.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "geometry/mesh/mesh_unit.h"
#include "scan/register_scans.h"

namespace patina {

// In order: frames give poses.tum; poses and probe give path.csv; paths give registered.csv and
// registration.json; heights give heights.csv and texture.json, and then the workspace and
// textured.obj in the first folder.
enum class ScanStep { track, filter, register_paths, texture };
const std::vector<std::string>& scanStepNames(); // "track", "filter", "register", "texture"

struct RunScanOptions {
  std::vector<std::filesystem::path> folders; // at least one; each gives a texture
  std::vector<std::filesystem::path> also;    // used for the registration only
  std::filesystem::path mesh;
  MeshUnit unit = MeshUnit::mm;
  std::filesystem::path workspace; // new workspace; empty if `to` is before the last step
  // First step to run. Absent: the first whose files are missing in a folder; a path that was found
  // wrong counts as missing. Paths are registered again if mesh, unit or paths have changed or the
  // pose was uncertain.
  std::optional<ScanStep> from;
  ScanStep to = ScanStep::texture;
  std::optional<double> tip_radius;     // radius of the probe's tip [m]; absent: that of the rigs
  ScanRegistrationOptions registration; // the scans' names are set
};

struct RunScanReport {
  struct Step {
    ScanStep step = ScanStep::track;
    std::filesystem::path folder;
    std::string found; // result as text
    double seconds = 0;
  };
  std::vector<Step> steps; // steps that ran
  std::vector<std::string> warnings;
  std::optional<RegisteredScans> registered; // if that step ran
  // All steps ran. Wrong paths stop before any is registered, and an uncertain pose before the
  // texture is mapped.
  bool done = false;
};

// Throws Error if a folder occurs twice or the workspace exists, Error and FileError as the steps
// do, Cancelled. Files of finished steps stay.
RunScanReport runScan(const RunScanOptions& options, Progress& progress);

} // namespace patina
