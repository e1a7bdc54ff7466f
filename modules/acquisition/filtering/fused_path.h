// The tip's path from camera and probe together (A06): an error-state Kalman filter with smoother.
// The camera measures the tip's position; the accelerometers measure its motion in between and, by
// gravity, the probe's tilt.
#pragma once

#include <array>

#include "acquisition/filtering/camera_track.h"
#include "acquisition/filtering/error_state.h"
#include "core/progress.h"
#include "core/types.h"

namespace patina {

struct FusedOptions {
  CameraTrackOptions camera;           // first pass, for the reference
  Vec3 gravity = Vec3(0, 0, -9.80665); // in the path's frame [m/s^2]
  double bias = 0.3;                   // prior deviation of each accelerometer axis [m/s^2]
  double rate_bias = 0.1;              // the same of the gyroscope [rad/s]
};

struct FusedPath {
  std::vector<PathSample> path;  // at the times of the probe's samples
  std::array<double, 4> bias{};  // estimated [m/s^2]
  Vec3 rate_bias = Vec3::Zero(); // the same of the gyroscope [rad/s]
  // Mean squared innovations of each axis, and of the poses, over their variance: far above 1 if
  // rig, gravity, clock or units are wrong. 0 without measurements.
  std::array<double, 4> axis_nis{};
  double pose_nis = 0;
  CameraTrack track; // camera-only track, with the fusion's verdicts on its poses
};

// Fuses the streams, which share a clock and are in the order of time. `rates` is empty if the
// probe has no gyroscope. Samples of the probe that are not finite, repeat a time or run backwards
// are left out. Poses far from the smoothed path get the small weight of Student's t with four
// degrees of freedom, not none, and the verdict of an outlier. The temporary memory is about 400
// bytes per sample. The path is empty if no pose is usable.
FusedPath fusePath(const std::vector<CameraPose>& poses, const std::vector<ProbeSample>& samples,
                   const ProbeModel& probe, const FusedOptions& options = {},
                   const std::vector<RateSample>& rates = {});

// The same in two steps: the camera's first pass and the fusion. Throws Cancelled.
CameraTrack firstPass(const std::vector<CameraPose>& poses, const ProbeModel& probe,
                      const FusedOptions& options);
FusedPath fuseWith(CameraTrack track, const std::vector<CameraPose>& poses,
                   const std::vector<ProbeSample>& samples, const ProbeModel& probe,
                   const FusedOptions& options, Progress& progress,
                   const std::vector<RateSample>& rates = {});

} // namespace patina
