// Reads the contents of a scan from a folder or a scene.
#pragma once

#include <memory>
#include <optional>

#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_tables.h"
#include "core/progress.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/scene_scan.h"

namespace patina {

// Each part is empty or absent if there is no file for it.
struct ScanFiles {
  bool of_scene = false;        // from a scene, not a folder
  bool pictures = false;        // only images, without times
  SceneScan scan;               // texts; the name of the folder or of the scene's scan
  std::filesystem::path folder; // folder of the frames; empty for a scan without frames in a scene
  std::vector<std::string> warnings; // one line for each table with ignored columns
  std::string problem;               // why existing frames cannot be read; else empty
  std::vector<Frame> frames;
  std::optional<Camera> camera;
  std::vector<RigMarker> markers;
  std::optional<Rig> rig;
  std::vector<ProbeSample> probe; // pressing forces are positive
  std::vector<RateSample> rates;  // gyroscope of the probe; empty without one
  std::vector<CameraPose> poses;
  std::vector<PathSample> path;
  std::shared_ptr<const TriangleMesh> mesh; // [m]
  std::optional<Pose> mesh_from_camera;

  bool canTrack() const { return !frames.empty() && camera && !markers.empty(); }
  Vec3 tip() const { return rig ? rig->probe.tip : Vec3(Vec3::Zero()); }
};

// Returns true if a folder holds frames, poses or a path of a scan, and is not a workspace.
bool isScanFolder(const std::filesystem::path& path);
// Throws FileError, Cancelled.
ScanFiles readScanFolder(const std::filesystem::path& folder, Progress& progress);
// Reads a scan of a scene. Missing or changed frames are a `problem`; the rest is read.
ScanFiles readScan(const SceneScan& scan, Progress& progress);

// Returns the tip's radius [m] that the rig.json files of these folders state, 0 if there is none:
// scans that are registered together have one probe. Throws FileError if they differ or cannot be
// read.
double tipRadiusOf(const std::vector<std::filesystem::path>& folders);

} // namespace patina
