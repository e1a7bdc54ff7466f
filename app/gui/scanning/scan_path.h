// Computes the path of a scan, and describes its defects.
#pragma once

#include <QString>

#include "scan/filter_scan.h"
#include "scan/scan_files.h"
#include "scan/track_scan.h"

namespace patina {

// Result of tracking a frame.
struct SeenFrame {
  bool looked = false;
  RigVerdict verdict = RigVerdict::no_marker;
  bool readable = true;
  std::size_t markers = 0;
  double rms = 0;  // Rms of corners [px].
  std::string why; // Why it has no pose; empty: it has one.
};

// Tracking quality, best first.
enum class FrameQuality { good, few, ambiguous, rejected, no_marker, unreadable, unknown };

// A missing or rejected part of a scan, with the reason.
struct Finding {
  enum class Kind { unreadable, no_marker, ambiguous, misfit, outlier, gap, dropout, doubt };
  Kind kind = Kind::gap;
  double from = 0, to = 0; // [s]
  QString words;
};
QString wordOf(Finding::Kind kind); // "gap"

struct ScanPath {
  std::vector<CameraPose> poses;
  FilteredScan filtered;          // Includes samples in the air.
  std::vector<ProbeSample> probe; // On the camera's clock.
  std::vector<PathSample> path;   // The part in contact, or everything without contact.
  std::vector<Finding> findings;  // In order of time.
};

// As `patina filter` has it; a path that the folder holds is shown as it is. Throws as
// filterStreams(), and Cancelled. Without poses only the findings about frames are there.
ScanPath pathOf(const ScanFiles& files, const std::vector<CameraPose>& poses,
                const std::vector<SeenFrame>& seen, Progress& progress);

// Quality of frame i; path may be nullptr: rejected poses are unknown.
FrameQuality qualityOf(const ScanFiles& files, const std::vector<SeenFrame>& seen,
                       const ScanPath* path, std::size_t i);
// Returns the index of the pose at a frame's time; nullopt: none.
std::optional<std::size_t> poseAt(const std::vector<CameraPose>& poses, double t);
Pose poseOf(const CameraPose& pose); // camera_from_probe

} // namespace patina
