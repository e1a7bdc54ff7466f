// Files of a scan folder. Other programs may read and write them too.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/profile/scan_heights.h"
#include "acquisition/values/camera.h"
#include "acquisition/values/scan_samples.h"
#include "core/csv_parser.h"
#include "core/line_buffer.h"

namespace patina {

// All readers throw FileError with the line: a word that is not a finite number, too few or too
// many values, time that repeats or runs backwards, an empty file. Readers of tables append a line
// to `warnings` if columns are left out.

template <class Value> struct OnFile {
  std::vector<Value> values;
  std::vector<std::size_t> lines; // line number of each value, from 1
};

// Default deviations of poses whose file has none.
struct PoseSigmas {
  double position = 0.2e-3; // each axis [m]
  double angle = 4.7e-3;    // about each axis [rad]
};

// TUM format: t tx ty tz qx qy qz qw in seconds and metres, one pose per line; '#' or '%' begins a
// comment. Two more numbers are the deviations of the position [m] and the angle [rad]. A table
// with the header t [s],tx [m],ty [m],tz [m],qx,qy,qz,qw and optionally sigma [m],sigma_angle [rad]
// is read too.
OnFile<CameraPose> readPoses(const std::filesystem::path& path,
                             const PoseSigmas& default_sigmas = {},
                             std::vector<std::string>* warnings = nullptr);
OnFile<CameraPose> parsePoses(const std::string& text, const std::string& name,
                              const PoseSigmas& default_sigmas = {},
                              std::vector<std::string>* warnings = nullptr);
void writePoses(const std::filesystem::path& path, const std::vector<CameraPose>& poses);
// Writes poses with their deviations, a comment with the reason for each missing pose, and one that
// begins with "# rig: " if there is a doubt of the rig, which readers add to their warnings.
struct MissingPose {
  double t = 0;
  std::string why;
};
void writePoses(const std::filesystem::path& path, const std::vector<CameraPose>& poses,
                const std::vector<MissingPose>& without, const std::string& rig_doubt = "");
std::string posesText(const std::vector<CameraPose>& poses, const std::vector<MissingPose>& without,
                      const std::string& rig_doubt = "");
// Single lines for programs that write while they record; the first one is posesHeader().
std::string posesHeader();
std::string poseRow(const CameraPose& pose);
std::string poseRow(const MissingPose& without);

// CSV files. A path's `touching` and `gap` are not written. A stream may have three columns of a
// gyroscope, wx wy wz [rad/s] in the probe's frame, which are appended to `rates` if it is given.
OnFile<ProbeSample> readProbeStream(const std::filesystem::path& path,
                                    std::vector<std::string>* warnings = nullptr,
                                    std::vector<RateSample>* rates = nullptr);
OnFile<ProbeSample> parseProbeStream(const std::string& text, const std::string& name,
                                     std::vector<std::string>* warnings = nullptr,
                                     std::vector<RateSample>* rates = nullptr);
// Parser for a stream of bytes in pieces of any size.
class ProbeLines {
 public:
  explicit ProbeLines(std::string name);
  // Prepares for a line that is joined in the middle: the first line is left out unless it is the
  // header, and numbers before any header are in the order and units of probeHeader(). A header
  // that comes later must say the same.
  void skipPartialLine() { joined_ = true; }
  // Appends the samples of complete lines, and a gyroscope's readings to `rates` if it is given. If
  // a line is wrong, those before it are appended first.
  void take(std::string_view bytes, std::vector<ProbeSample>& into,
            std::vector<RateSample>* rates = nullptr);
  void end() const; // throws FileError if the last line is incomplete
  std::string leftOut() const { return table_.leftOut(); }

 private:
  bool isHeader(std::string_view line);

  std::string name_;
  LineBuffer lines_;
  CsvParser table_;
  bool joined_ = false;
  std::string header_; // the text of the table's header, or of the one that is assumed
  std::optional<bool> gyroscope_; // known with the first row
  std::optional<double> last_;
};
// Single rows for programs that write while they record; the first one is probeHeader(). With a
// gyroscope each row has its reading.
std::string probeHeader(bool gyroscope = false);
std::string probeRow(const ProbeSample& sample, const RateSample* rate = nullptr);
// `rates` is empty or has one for each sample, at the same time.
void writeProbeStream(const std::filesystem::path& path, const std::vector<ProbeSample>& samples,
                      const std::vector<RateSample>& rates = {});
std::vector<PathSample> readPath(const std::filesystem::path& path,
                                 std::vector<std::string>* warnings = nullptr);
std::vector<PathSample> parsePath(const std::string& text, const std::string& name,
                                  std::vector<std::string>* warnings = nullptr);
std::string pathText(const std::vector<PathSample>& samples);
void writePath(const std::filesystem::path& path, const std::vector<PathSample>& samples);
// Writes both files, or neither if the disk has no room for both.
void writePath(const std::filesystem::path& path, const std::vector<PathSample>& samples,
               const std::filesystem::path& heights_path, const std::vector<ScanHeight>& heights);
// Heights must have their speeds.
void writeHeights(const std::filesystem::path& path, const std::vector<ScanHeight>& heights);

// Content of rig.json except its markers.
struct Rig {
  ProbeModel probe;
  // True if the accelerometers' positions are known; otherwise only the force is used.
  bool accelerometers = false;
  bool gyroscope = false;              // true if the file states the gyroscope's noise
  Vec3 gravity = Vec3(0, 0, -9.80665); // in the camera's frame [m/s^2]
  double force_zero = 0;               // what the force shows while nothing is pressed [N]
  double force_gain = 1;               // pressing force over the shown one
  double tip_radius = 0;               // radius of the round tip [m]; 0: a point
};
// Returns the pressing force [N] for a raw reading. Every reader of a stream uses it.
inline double forceOf(const Rig& rig, double shown) {
  return rig.force_gain * (shown - rig.force_zero);
}
Rig readRig(const std::filesystem::path& path);
Rig parseRig(const std::string& text, const std::string& name);
std::string rigText(const Rig& rig, const std::vector<RigMarker>& markers = {});
// Markers of rig.json, each with `dictionary`, `id`, `size` [m] and `probe_from_marker`, 4 x 4.
// There is at least one, and none occurs twice.
std::vector<RigMarker> readMarkers(const std::filesystem::path& path);
std::vector<RigMarker> parseMarkers(const std::string& text, const std::string& name);

// Deviations that calibrations have added to rig.json.
struct RigDeviations {
  bool calibrated = false;    // rig.json has content that a printed rig has not
  std::optional<double> tip;  // largest of the tip's three [m]
  std::optional<double> size; // largest of the markers' sizes, relative
};
RigDeviations parseRigDeviations(const std::string& text, const std::string& name);

} // namespace patina
