// What a scan's poses and samples come to: its path, and what in it cannot be trusted, in words.
#pragma once

#include <QString>

#include "acquisition/filtering/filtered_scan.h"
#include "acquisition/tracking/rig_pose.h"
#include "scan/scan_files.h"

namespace patina {

// What a look at a frame has found.
struct SeenFrame {
  bool looked = false;
  RigVerdict verdict = RigVerdict::no_marker;
  bool readable = true;
  std::size_t markers = 0, dropped = 0;
  double rms = 0;  // of corners [px]
  std::string why; // it has no pose; empty: it has one
};

// How much a frame is worth, best first.
enum class FrameQuality { good, few, ambiguous, rejected, no_marker, unreadable, unknown };

// Something of a scan that is missing or was left out, and why.
struct Finding {
  enum class Kind { unreadable, no_marker, ambiguous, misfit, outlier, gap, dropout, doubt };
  Kind kind = Kind::gap;
  double from = 0, to = 0; // [s]
  QString words;
};
QString wordOf(Finding::Kind kind); // "gap"

struct ScanPath {
  std::vector<CameraPose> poses;
  FilteredScan filtered;          // with what the probe did in the air
  std::vector<ProbeSample> probe; // on the camera's clock
  std::vector<PathSample> path;   // what is shown: where it touches, or all where it never does
  std::vector<Finding> findings;  // in the order of time
};

// As `patina filter` has it; a path that the folder holds is shown as it is. Throws as
// filterScan(), and Cancelled. Without poses only the findings about frames are there.
ScanPath pathOf(const ScanFiles& files, const std::vector<CameraPose>& poses,
                const std::vector<SeenFrame>& seen, Progress& progress);

// Of frame i. `path` may be null: nothing is known of what was rejected.
FrameQuality qualityOf(const ScanFiles& files, const std::vector<SeenFrame>& seen,
                       const ScanPath* path, std::size_t i);
// The pose at a time of a frame, and where it stands in the list; nullopt: none.
std::optional<std::size_t> poseAt(const std::vector<CameraPose>& poses, double t);
Pose poseOf(const CameraPose& pose); // camera_from_probe

} // namespace patina
