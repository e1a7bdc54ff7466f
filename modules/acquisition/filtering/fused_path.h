// The tip's path from camera and probe together (A06): an error-state filter, smoothed. The camera
// says where the tip is, the accelerometers how it moves in between and, by gravity, how the probe
// is tilted.
#pragma once

#include "acquisition/filtering/camera_track.h"
#include "core/progress.h"

namespace patina {

struct FusedOptions {
  CameraTrackOptions camera;           // the first pass: gate and reference
  Vec3 gravity = Vec3(0, 0, -9.80665); // in the path's frame [m/s^2]
  double bias = 0.3;                   // of each accelerometer axis, standard deviation [m/s^2]
};

struct FusedPath {
  std::vector<PathSample> path; // at the times of the probe's samples
  std::array<double, 4> bias{}; // that was found [m/s^2]
  // Mean squares of what each axis, and of what poses, say against what was expected of them, over
  // their variance: far above 1 where rig, gravity, clock or units are wrong. 0 without any.
  std::array<double, 4> axis_nis{};
  double pose_nis = 0;
  CameraTrack track; // of the camera alone, with verdicts on its poses
};

// Both streams on one clock, in the order of time; samples of the probe that are not finite, repeat
// a time or run backwards are left out. Poses that the first pass rejects are not used. The memory
// it takes beside the path grows by 250 bytes a sample. Without a usable pose the path is empty.
FusedPath fusePath(const std::vector<CameraPose>& poses, const std::vector<ProbeSample>& samples,
                   const ProbeModel& probe, const FusedOptions& options = {});

// The same in two steps: the first pass, and what follows it. Throws Cancelled.
CameraTrack firstPass(const std::vector<CameraPose>& poses, const ProbeModel& probe,
                      const FusedOptions& options);
FusedPath fuseWith(CameraTrack track, const std::vector<CameraPose>& poses,
                   const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                   const FusedOptions& options, Progress& progress);

} // namespace patina
