// Filters a whole scan, for the command and the window.
#pragma once

#include <optional>
#include <string>

#include "acquisition/filtering/camera_track.h"
#include "acquisition/filtering/fused_path.h"
#include "acquisition/filtering/probe_clock.h"

namespace patina {

enum class PathModel { fused, acceleration, velocity };

struct ScanFilter {
  PathModel model = PathModel::fused;  // acceleration if the accelerometers are not calibrated
  bool smooth = true;                  // the fused model always smooths
  bool touching_only = true;           // leaves out samples without contact
  double longest_pause = 0.05;         // longest step between the probe's samples [s]
  Vec3 gravity = Vec3(0, 0, -9.80665); // in the camera's frame [m/s^2]
};

struct FilteredScan {
  std::vector<PathSample> path; // within the poses' times, on the camera's clock
  CameraTrack track;
  std::array<double, 4> bias{}; // accelerometers [m/s^2]; 0 if they were not used
  std::vector<Gap> without_pose, without_sample;
  double largest_force = 0; // [N]
  // Input of scanHeights(): the fused path at each sample of the probe, including the air, and the
  // samples on the camera's clock. Both are empty for the other models.
  std::vector<PathSample> whole;
  std::vector<ProbeSample> samples;
  std::optional<ProbeClock> clock;  // absent unless known or applied; applied if it differs
  std::array<double, 4> axis_nis{}; // see FusedPath, also for pose_nis; 0 if not used
  double pose_nis = 0;
  std::vector<std::string> warnings; // reasons why the result may be wrong
  bool is_wrong = false;             // streams or poses contradict one another
};

// `samples` may be empty; the path then is at the poses' times, has no force and is not cut. Throws
// Cancelled, and Error if the streams do not overlap in time.
FilteredScan filterScan(const std::vector<CameraPose>& poses,
                        const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                        const ScanFilter& filter, Progress& progress,
                        const std::vector<RateSample>& rates = {});

} // namespace patina
