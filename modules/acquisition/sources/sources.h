// Sources of frames and probe samples, read by one thread; another one may stop them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/values/camera.h"
#include "acquisition/values/scan_samples.h"

namespace patina {

struct SourceFrame {
  double t = 0;      // [s], on the source's clock
  std::string name;  // file name or frame number, for messages
  GreyFrame image;   // empty if it could not be read
  std::string fault; // reason why it could not be read
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // Waits for the next frame; nullopt: the source has ended. Throws Error if the source fails (a
  // camera that is unplugged); a single unreadable frame is no failure.
  virtual std::optional<SourceFrame> next() = 0;
  // Number of frames; nullopt: unknown or live.
  virtual std::optional<std::size_t> count() const = 0;
  virtual bool isLive() const = 0;
  virtual void stop() noexcept = 0; // from any thread: next() returns nullopt within 0.2 s
  // Asks to return only each `step`-th frame, before the first. Returns false if the source cannot
  // leave frames out; then all come.
  virtual bool keepEach(std::size_t) { return false; }
  // Returns true for independent pictures, false for consecutive frames.
  virtual bool arePictures() const { return false; }
  // Remarks for the reading thread, one line each: files left out, missing times.
  virtual std::vector<std::string> notes() const { return {}; }
};

// `frames` is a scan folder or folder of pictures (framesOf()), a video file, a live camera
// ("camera:0", "camera:1", ...), or "replay:SCAN", the frames of a scan folder in real time, as if
// live. `rate` applies to sources without times and overrides that of a video; 0: not given. Single
// missing frames are gaps; throws FileError if all are missing, and FileError or Error for an
// unknown source.
std::unique_ptr<FrameSource> openFrames(const std::string& frames, double rate);

// Returns the folder of "replay:SCAN" or a folder; nullopt: a camera or a video.
std::optional<std::filesystem::path> scanFolderOf(const std::string& frames);

// Statistics of a packet stream (docs/usb_protocol.md).
struct ProbeHealth {
  std::size_t packets = 0;      // packets read
  std::size_t lost_packets = 0; // packets missing for any reason
  std::size_t lost_samples = 0; // samples in them
  std::size_t corrupt = 0;      // invalid packets, included in the lost ones
  std::size_t repeated = 0;     // packets repeated or too late, which were left out
  std::size_t restarts = 0;     // restarts of the probe
  std::size_t saturated = 0;    // samples beyond a sensor's range
  std::size_t silent = 0;       // packets in which a sensor did not answer the probe
  std::optional<double> skew{}; // relative excess rate of the probe's clock over this machine's
  bool operator==(const ProbeHealth&) const = default;
};

class ProbeSource {
 public:
  virtual ~ProbeSource() = default;
  // Waits for data and appends them; returns false at the end. Throws Error if the source fails,
  // naming the wrong line or the missing serial device; earlier data are appended first. If the
  // probe has a gyroscope, a reading for each sample is appended to `rates` unless that is nullptr.
  virtual bool read(std::vector<ProbeSample>& into, std::vector<RateSample>* rates) = 0;
  bool read(std::vector<ProbeSample>& into) { return read(into, nullptr); }
  virtual bool isLive() const = 0;
  virtual void stop() noexcept = 0; // from any thread: read() returns false within 0.2 s
  // Statistics of a packet source; for the reading thread.
  virtual std::optional<ProbeHealth> health() const { return std::nullopt; }
  // Names the columns of a table that are not read, or is empty; for the reading thread.
  virtual std::string leftOut() const { return ""; }
};

// `probe` is a probe.csv; "stream:PATH", lines of a probe.csv with its header from a pipe or a
// serial device; "serial:PATH", the packets of docs/usb_protocol.md from a serial device; "usb:" or
// "usb:SERIAL", the same from the first or the given probe on the bus; or "replay:SCAN". The PATH
// of a serial device may be followed by "@BAUD", its rate [bit/s], unless it is set already. Throws
// FileError, DeviceError or Error.
std::unique_ptr<ProbeSource> openProbe(const std::string& probe);

} // namespace patina
