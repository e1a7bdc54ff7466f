// The files of a scan folder, which any other program may read and write in our place.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/camera.h"
#include "acquisition/profile/scan_heights.h"
#include "acquisition/scan_samples.h"

namespace patina {

// All readers throw FileError with the line: a word that is no number or not finite, a decimal
// comma, too few or too many of them, time that repeats or runs backwards, nothing at all.

template <class Value> struct OnFile {
  std::vector<Value> values;
  std::vector<std::size_t> lines; // on which each stands, from 1
};

// Deviations of poses that do not tell their own.
struct PoseSigmas {
  double position = 0.2e-3; // of each axis [m]
  double angle = 4.7e-3;    // about each axis [rad]
};

// TUM: t tx ty tz qx qy qz qw in seconds and metres, a pose a line; '#' begins a comment. Two more
// numbers are deviations of the position [m] and the angle [rad].
OnFile<CameraPose> readPoses(const std::filesystem::path& path, const PoseSigmas& unsaid = {});
void writePoses(const std::filesystem::path& path, const std::vector<CameraPose>& poses);
// With their deviations, and a comment for each time without a pose that says why.
struct NoPose {
  double t = 0;
  std::string why;
};
void writePoses(const std::filesystem::path& path, const std::vector<CameraPose>& poses,
                const std::vector<NoPose>& without);

// CSV. `touching` and `gap` of a path are not in it.
OnFile<ProbeSample> readProbeStream(const std::filesystem::path& path);
void writeProbeStream(const std::filesystem::path& path, const std::vector<ProbeSample>& samples);
std::vector<PathSample> readPath(const std::filesystem::path& path);
void writePath(const std::filesystem::path& path, const std::vector<PathSample>& samples);
void writeHeights(const std::filesystem::path& path, const std::vector<ScanHeight>& heights);

// What rig.json says beside its markers.
struct Rig {
  ProbeModel probe;
  // Where the accelerometers sit is known; if it is not, only force is read of the probe.
  bool accelerometers = false;
  Vec3 gravity = Vec3(0, 0, -9.80665); // in the camera's frame [m/s^2]
  double force_zero = 0;               // what the force shows while nothing is pressed [N]
};
Rig readRig(const std::filesystem::path& path);
std::string rigText(const Rig& rig, const std::vector<RigMarker>& markers = {});
// The markers of rig.json: each with `dictionary`, `id`, `size` [m] and `probe_from_marker`, 4 x 4;
// one at least, none twice.
std::vector<RigMarker> readMarkers(const std::filesystem::path& path);

} // namespace patina
