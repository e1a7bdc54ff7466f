// The files of a scan folder, which any other program may read and write in our place.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/camera.h"
#include "acquisition/profile/scan_heights.h"
#include "acquisition/scan_samples.h"
#include "core/csv_parser.h"
#include "core/line_buffer.h"

namespace patina {

// All readers throw FileError with the line: a word that is no number or not finite, too few or too
// many of them, time that repeats or runs backwards, nothing at all. Readers of tables append a
// line to `warnings` where columns are left out.

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
// numbers are deviations of the position [m] and the angle [rad]. The same as a table with a
// header: t [s],tx [m],ty [m],tz [m],qx,qy,qz,qw and perhaps sigma [m],sigma_angle [rad].
OnFile<CameraPose> readPoses(const std::filesystem::path& path, const PoseSigmas& unsaid = {},
                             std::vector<std::string>* warnings = nullptr);
OnFile<CameraPose> parsePoses(const std::string& text, const std::string& name,
                              const PoseSigmas& unsaid = {},
                              std::vector<std::string>* warnings = nullptr);
void writePoses(const std::filesystem::path& path, const std::vector<CameraPose>& poses);
// With their deviations, and a comment for each time without a pose that says why.
struct NoPose {
  double t = 0;
  std::string why;
};
void writePoses(const std::filesystem::path& path, const std::vector<CameraPose>& poses,
                const std::vector<NoPose>& without);
std::string posesText(const std::vector<CameraPose>& poses, const std::vector<NoPose>& without);
// A line of its own of such a file, for what writes them as they come; the first is posesHeader().
std::string posesHeader();
std::string poseRow(const CameraPose& pose);
std::string poseRow(const NoPose& without);

// CSV. `touching` and `gap` of a path are not in it.
OnFile<ProbeSample> readProbeStream(const std::filesystem::path& path,
                                    std::vector<std::string>* warnings = nullptr);
OnFile<ProbeSample> parseProbeStream(const std::string& text, const std::string& name,
                                     std::vector<std::string>* warnings = nullptr);
// The same of bytes as they come, in any pieces.
class ProbeLines {
 public:
  explicit ProbeLines(std::string name);
  void skipFirst() { skip_ = true; } // half a line perhaps, in place of the header
  // Appends the samples whose lines are whole; where one is wrong, those before it too.
  void take(std::string_view bytes, std::vector<ProbeSample>& into);
  void end() const; // throws FileError in the middle of a line
  std::string leftOut() const { return table_.leftOut(); }

 private:
  std::string name_;
  LineBuffer lines_;
  CsvParser table_;
  bool skip_ = false;
  std::optional<double> last_;
};
// A row of its own, for what writes them as they come; the first is probeHeader().
std::string probeHeader();
std::string probeRow(const ProbeSample& sample);
void writeProbeStream(const std::filesystem::path& path, const std::vector<ProbeSample>& samples);
std::vector<PathSample> readPath(const std::filesystem::path& path,
                                 std::vector<std::string>* warnings = nullptr);
std::vector<PathSample> parsePath(const std::string& text, const std::string& name,
                                  std::vector<std::string>* warnings = nullptr);
std::string pathText(const std::vector<PathSample>& samples);
void writePath(const std::filesystem::path& path, const std::vector<PathSample>& samples);
// Both files, or neither where the disk has no room for both.
void writePath(const std::filesystem::path& path, const std::vector<PathSample>& samples,
               const std::filesystem::path& heights_path, const std::vector<ScanHeight>& heights);
// Heights whose speeds are known.
void writeHeights(const std::filesystem::path& path, const std::vector<ScanHeight>& heights);

// What rig.json says beside its markers.
struct Rig {
  ProbeModel probe;
  // Where the accelerometers sit is known; if it is not, only force is read of the probe.
  bool accelerometers = false;
  Vec3 gravity = Vec3(0, 0, -9.80665); // in the camera's frame [m/s^2]
  double force_zero = 0;               // what the force shows while nothing is pressed [N]
  double force_gain = 1;               // of the force that presses to what is shown beyond it
};
// What presses, from what the probe shows. Every reader of a stream goes through this.
inline double forceOf(const Rig& rig, double shown) {
  return rig.force_gain * (shown - rig.force_zero);
}
Rig readRig(const std::filesystem::path& path);
Rig parseRig(const std::string& text, const std::string& name);
std::string rigText(const Rig& rig, const std::vector<RigMarker>& markers = {});
// The markers of rig.json: each with `dictionary`, `id`, `size` [m] and `probe_from_marker`, 4 x 4;
// one at least, none twice.
std::vector<RigMarker> readMarkers(const std::filesystem::path& path);
std::vector<RigMarker> parseMarkers(const std::string& text, const std::string& name);

} // namespace patina
