// Frames of a camera become poses of the rig (A04).
#pragma once

#include <functional>

#include "acquisition/files/scan_files.h"
#include "acquisition/sources/sources.h"
#include "acquisition/tracking/rig_pose.h"
#include "core/progress.h"

namespace patina {

class RigTracker {
 public:
  // Throws Error: a family or an id that there is not.
  RigTracker(const Camera& camera, const std::vector<RigMarker>& rig,
             const FinderOptions& options = {});
  // The camera of frames that are turned.
  void setCamera(const Camera& camera) { camera_ = camera; }
  // `t` tells how long ago the last pose was.
  SeenRig track(const GreyFrame& image, double t);
  const std::vector<SeenMarker>& markers() const { return markers_; } // in that image

 private:
  Camera camera_;
  std::vector<RigMarker> rig_;
  FinderOptions options_;
  std::vector<CodeBook> books_;
  std::vector<SeenMarker> markers_;
  std::optional<Pose> last_;
  double last_t_ = 0;
};

// Of a rig that was seen, with the rms of its deviations.
CameraPose cameraPose(const SeenRig& seen, double t);

struct TrackedFrames {
  std::size_t frames = 0;
  std::vector<CameraPose> poses;
  std::vector<NoPose> without; // with the reason: the frame is missing, unreadable or shows no pose
  std::size_t unreadable = 0, ambiguous = 0, misfit = 0; // of those
  std::size_t dropped = 0;                               // markers that contradicted the others
  double rms = 0;                                        // of all corners [px]
  std::string first_fault = {};                          // of the first that cannot be read
  std::size_t repeated = 0;            // frames in which a marker of the rig is seen more than once
  std::string first_repeated = {};     // the first of them, its marker and places
  std::vector<std::string> notes = {}; // a line each: of the source, and of frames that were turned
};

// Lines for a person: its notes, and what of the frames or of the rig may be wrong. `frames` and
// `rig` are how they were named.
std::vector<std::string> warningsOf(const TrackedFrames& found, const std::string& frames,
                                    const std::filesystem::path& rig);

// Each frame once it was looked at, in their order; `why` says why it has no pose, if it has none.
using FrameListener =
    std::function<void(std::size_t frame, const SeenRig& seen, const std::string& why)>;

// All frames of a source that ends; a live one until it is cancelled, which then is no error. A
// frame of another size than the camera's, as it is shown or as it is stored, throws FileError: its
// calibration is not theirs.
TrackedFrames trackFrames(FrameSource& frames, const Camera& camera,
                          const std::vector<RigMarker>& rig, const FinderOptions& options,
                          Progress& progress, const FrameListener& listener = {});

} // namespace patina
