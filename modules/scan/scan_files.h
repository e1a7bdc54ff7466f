// What is in a scan, of a folder or of a scene, as it was read.
#pragma once

#include <memory>
#include <optional>

#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_files.h"
#include "core/progress.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/scene_scan.h"

namespace patina {

// Each part is empty or absent where the folder has no file of it.
struct ScanFiles {
  bool of_scene = false;        // else of a folder
  bool pictures = false;        // only those, of which nobody knows when they were taken
  SceneScan scan;               // the texts; named as its folder is, or as in the scene
  std::filesystem::path folder; // that holds the frames; of a scene's scan empty where it has none
  std::vector<std::string> warnings; // a line for each table with columns that are left out
  std::string problem; // why there are no frames, though the scan has some; else empty
  std::vector<Frame> frames;
  std::optional<Camera> camera;
  std::vector<RigMarker> markers;
  std::optional<Rig> rig;
  std::vector<ProbeSample> probe; // forces are those that press
  std::vector<CameraPose> poses;
  std::vector<PathSample> path;
  std::shared_ptr<const TriangleMesh> mesh; // [m]
  std::optional<Pose> mesh_from_camera;

  bool canTrack() const { return !frames.empty() && camera && !markers.empty(); }
  Vec3 tip() const { return rig ? rig->probe.tip : Vec3(Vec3::Zero()); }
};

// Whether a folder holds frames, poses or a path of a scan. A workspace never is one.
bool isScanFolder(const std::filesystem::path& path);
// Throws FileError, Cancelled.
ScanFiles readScanFolder(const std::filesystem::path& folder, Progress& progress);
// The same of a scene's. Frames that are gone or others are a `problem`: the rest is there.
ScanFiles readScan(const SceneScan& scan, Progress& progress);

} // namespace patina
