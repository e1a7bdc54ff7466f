// Computes the rig's poses from a camera's frames (A04).
#pragma once

#include <functional>

#include "acquisition/files/scan_tables.h"
#include "acquisition/sources/sources.h"
#include "acquisition/tracking/rig_pose.h"
#include "core/progress.h"

namespace patina {

// Returns the codes of a rig's markers. Throws Error for an unknown family or id.
std::vector<CodeBook> codeBooksOf(const std::vector<RigMarker>& rig);

class RigTracker {
 public:
  // Throws Error for an unknown family or id.
  RigTracker(const Camera& camera, const std::vector<RigMarker>& rig,
             const FinderOptions& options = {});
  // Sets the camera of turned frames.
  void setCamera(const Camera& camera) { camera_ = camera; }
  SeenRig track(const GreyFrame& image, double t); // `t` [s] gives the age of the last pose
  const std::vector<SeenMarker>& markers() const { return markers_; } // in the last image

 private:
  Camera camera_;
  std::vector<RigMarker> rig_;
  FinderOptions options_;
  std::vector<CodeBook> books_;
  std::vector<SeenMarker> markers_;
  std::optional<Pose> last_;
  double last_t_ = 0;
};

// Returns the pose of a detected rig, with the rms of its deviations.
CameraPose cameraPose(const SeenRig& seen, double t);

struct TrackedFrames {
  std::size_t frames = 0;
  std::vector<CameraPose> poses;
  std::vector<MissingPose> without; // reason: the frame is missing, unreadable or shows no pose
  std::size_t unreadable = 0, ambiguous = 0, misfit = 0; // counts in `without`
  std::size_t dropped = 0;                               // outlier markers
  double rms = 0;                                        // all corners [px]
  std::string first_fault = {};                          // error of the first unreadable frame
  std::size_t repeated = 0;        // frames in which a marker of the rig is detected more than once
  std::string first_repeated = {}; // the first of them, with marker and places
  std::vector<std::string> notes = {}; // remarks about the source and turned frames, one line each
  std::string rig_doubt = {};          // how the rig differs from its file; empty: it does not

  // Returns true if most frames drop a marker and no cause is found: the poses may be wrong.
  bool isOfAnotherRig() const { return rig_doubt.empty() && 2 * dropped > poses.size(); }
};

// Returns messages about possible faults of `frames` or `rig`, whose names are as given.
std::vector<std::string> warningsOf(const TrackedFrames& found, const std::string& frames,
                                    const std::filesystem::path& rig);

// Called for each frame in order; `why` is the reason for a missing pose, else empty.
using FrameListener =
    std::function<void(std::size_t frame, const SeenRig& seen, const std::string& why)>;

// Tracks all frames of a source that ends, or a live one until it is cancelled, which then is not
// an error. Throws FileError if a frame, as shown or as stored, has another size than the camera.
TrackedFrames trackFrames(FrameSource& frames, const Camera& camera,
                          const std::vector<RigMarker>& rig, const FinderOptions& options,
                          Progress& progress, const FrameListener& listener = {});

} // namespace patina
