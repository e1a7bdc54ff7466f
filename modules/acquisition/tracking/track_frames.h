// Frames of a camera become poses of the rig (A04).
#pragma once

#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_files.h"
#include "acquisition/tracking/rig_pose.h"
#include "core/progress.h"

namespace patina {

class RigTracker {
 public:
  // Throws Error: a family or an id that there is not.
  RigTracker(const Camera& camera, const std::vector<RigMarker>& rig,
             const FinderOptions& options = {});
  // `t` tells how long ago the last pose was.
  SeenRig track(const GreyFrame& image, double t);

 private:
  Camera camera_;
  std::vector<RigMarker> rig_;
  FinderOptions options_;
  std::vector<CodeBook> books_;
  std::optional<Pose> last_;
  double last_t_ = 0;
};

struct TrackedFrames {
  std::vector<CameraPose> poses;
  std::vector<NoPose> without; // with the reason: the frame is missing, unreadable or shows no pose
  std::size_t unreadable = 0, ambiguous = 0, misfit = 0; // of those
  std::size_t dropped = 0;                               // markers that contradicted the others
  double rms = 0;                                        // of all corners [px]
};

// A frame of another size than the camera's throws FileError: its calibration is not theirs.
TrackedFrames trackFrames(const std::vector<Frame>& frames, const Camera& camera,
                          const std::vector<RigMarker>& rig, const FinderOptions& options,
                          Progress& progress);

} // namespace patina
