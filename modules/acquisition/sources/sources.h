// Where frames and the probe's samples come from: files that end, or devices that go on. One thread
// reads a source; another may stop it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/camera.h"
#include "acquisition/scan_samples.h"

namespace patina {

struct SourceFrame {
  double t = 0;      // [s], on the source's own clock
  std::string name;  // what a person finds it by: a file, or its number
  GreyFrame image;   // empty where it could not be read; then
  std::string fault; // says why
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // The next frame, once it is there; nullopt: no more will come. Throws Error where the source
  // itself fails (a camera that is pulled out), which a single bad frame does not.
  virtual std::optional<SourceFrame> next() = 0;
  // How many there are; nullopt: nobody knows, or it goes on until it is stopped.
  virtual std::optional<std::size_t> count() const = 0;
  virtual bool isLive() const = 0;
  virtual void stop() noexcept = 0; // from any thread: next() returns nullopt within 0.2 s
  // Whether a person took them one by one, none like another.
  virtual bool arePictures() const { return false; }
  // What is told of it, a line each, by the thread that reads: files that are left out, times that
  // a video does not have.
  virtual std::vector<std::string> notes() const { return {}; }
};

// FRAMES is a scan folder or folder of pictures (framesOf()), a video file, "camera:0", "camera:1"
// and so on, a live camera, or "replay:SCAN", the frames of a scan folder at the pace at which they
// were taken, as if live. `rate` is for what carries no time, and overrules a video's own; 0: not
// told. One frame that is missing is a gap; throws FileError where all are, and FileError or Error
// for what is no source.
std::unique_ptr<FrameSource> openFrames(const std::string& frames, double rate);

// The folder of "replay:SCAN" or of what is a folder; nullopt: a camera, a video.
std::optional<std::filesystem::path> scanFolderOf(const std::string& frames);

// How a stream of numbered packets (docs/usb_protocol.md) has come over so far.
struct ProbeHealth {
  std::size_t packets = 0;      // that were read
  std::size_t lost_packets = 0; // whose numbers never came, whatever the reason
  std::size_t lost_samples = 0; // in them
  std::size_t corrupt = 0;      // that came and could not be read: they are among the lost
  std::size_t repeated = 0;     // that came again or too late, and were left out
  std::size_t restarts = 0;     // of the probe, in the middle
  std::size_t saturated = 0;    // samples beyond a sensor's range
  std::size_t silent = 0;       // packets in which a sensor did not answer the probe
  std::optional<double> skew{}; // by how much the probe's clock runs faster than this machine's
  bool operator==(const ProbeHealth&) const = default;
};

class ProbeSource {
 public:
  virtual ~ProbeSource() = default;
  // Appends what has come since the last call, once there is something; false: no more will come.
  // Throws Error where the source fails, naming the line that is wrong, or the serial device that
  // is gone; what came before it has been given.
  virtual bool read(std::vector<ProbeSample>& into) = 0;
  virtual bool isLive() const = 0;
  virtual void stop() noexcept = 0; // from any thread: read() returns false within 0.2 s
  // Of what sends packets; for the thread that reads.
  virtual std::optional<ProbeHealth> health() const { return std::nullopt; }
  // Names the columns of a table that nobody reads, or is empty; for the thread that reads.
  virtual std::string leftOut() const { return ""; }
};

// PROBE is a probe.csv, "stream:PATH", lines of a probe.csv, its header first, as they arrive at a
// pipe or a serial device, "serial:PATH", the packets of docs/usb_protocol.md on a serial device,
// "usb:" or "usb:SERIAL", the same of the first or the named probe on the bus, or "replay:SCAN".
// Throws FileError, DeviceError or Error.
std::unique_ptr<ProbeSource> openProbe(const std::string& probe);

} // namespace patina
