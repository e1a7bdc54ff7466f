// A whole scan through the filter: what the command and the window show and write.
#pragma once

#include <string>

#include "acquisition/filtering/fused_path.h"
#include "acquisition/filtering/probe_clock.h"

namespace patina {

enum class PathModel { fused, acceleration, velocity };

struct ScanFilter {
  PathModel model = PathModel::fused;  // where accelerometers are not known: acceleration
  bool smooth = true;                  // fused always is
  bool touching_only = true;           // leaves out what the probe did in the air
  double longest_pause = 0.05;         // between samples of the probe [s]
  Vec3 gravity = Vec3(0, 0, -9.80665); // in the camera's frame [m/s^2]
};

struct FilteredScan {
  std::vector<PathSample> path; // within the poses' times, on the camera's clock
  CameraTrack track;
  std::array<double, 4> bias{}; // of the accelerometers [m/s^2]; 0 where they were not used
  std::vector<Gap> without_pose, without_sample;
  double largest_force = 0; // [N]
  // scanHeights() makes heights of these two without another run of the filter: the fused path at
  // each sample of the probe, in the air too, and those samples on the camera's clock. Both are
  // empty for the other models.
  std::vector<PathSample> whole;
  std::vector<ProbeSample> samples;
  std::optional<ProbeClock> clock;  // where accelerometers are known; corrected where it differs
  std::array<double, 4> axis_nis{}; // of FusedPath, as pose_nis; 0 where it was not used
  double pose_nis = 0;
  std::vector<std::string> doubts; // in words: why its numbers may be wrong
};

// `samples` may be empty: the path then is at the poses' times, has no force and is not cut. Throws
// Cancelled, and Error where the streams have no time in common.
FilteredScan filterScan(const std::vector<CameraPose>& poses,
                        const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                        const ScanFilter& filter, Progress& progress);

} // namespace patina
