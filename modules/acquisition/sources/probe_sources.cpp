#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <sys/eventfd.h>
#include <termios.h>
#include <unistd.h>

#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_tables.h"
#include "acquisition/sources/pace.h"
#include "acquisition/sources/probe_decoder.h"
#include "acquisition/sources/sources.h"
#include "acquisition/sources/usb_probe.h"
#include "core/descriptor.h"
#include "core/error.h"
#include "core/numbers.h"
#include "usb/usb_bus.h"

namespace patina {
namespace {

class ProbeFile : public ProbeSource {
 public:
  ProbeFile(const std::string& path)
      : samples_(readProbeStream(path, &warnings_, &rates_).values) {}
  bool read(std::vector<ProbeSample>& into, std::vector<RateSample>* rates) override {
    if (stopped_ || samples_.empty()) return false;
    into.insert(into.end(), samples_.begin(), samples_.end());
    if (rates) rates->insert(rates->end(), rates_.begin(), rates_.end());
    samples_.clear();
    return true;
  }
  bool isLive() const override { return false; }
  void stop() noexcept override { stopped_ = true; }
  std::string leftOut() const override { return warnings_.empty() ? "" : warnings_[0]; }

 private:
  std::vector<std::string> warnings_;
  std::vector<RateSample> rates_;
  std::vector<ProbeSample> samples_;
  std::atomic<bool> stopped_{false};
};

class ReplayedProbe : public ProbeSource {
 public:
  ReplayedProbe(const std::string& folder)
      : samples_(
            readProbeStream(std::filesystem::path(folder) / "probe.csv", nullptr, &rates_).values) {
    start_ = samples_[0].t;
    if (std::filesystem::exists(std::filesystem::path(folder) / "frames.csv"))
      start_ = std::min(start_, framesOf(folder, 0)[0].t);
  }
  bool read(std::vector<ProbeSample>& into, std::vector<RateSample>* rates) override {
    pace_.now();
    if (at_ == samples_.size() || !pace_.waitUntil(samples_[at_].t - start_)) return false;
    const double now = pace_.now();
    for (; at_ < samples_.size() && samples_[at_].t - start_ <= now; ++at_) {
      into.push_back(samples_[at_]);
      if (rates && !rates_.empty()) rates->push_back(rates_[at_]);
    }
    return true;
  }
  bool isLive() const override { return true; }
  void stop() noexcept override { pace_.stop(); }

 private:
  std::vector<RateSample> rates_; // one for each sample, or none
  std::vector<ProbeSample> samples_;
  double start_ = 0;
  std::size_t at_ = 0;
  StoppableTimer pace_;
};

// The path of a pipe or a serial device, and the rate of the latter if it is given.
struct PathAndRate {
  std::string path;
  std::optional<unsigned> baud{}; // [bit/s]
};

// Splits "PATH@BAUD"; a file of the whole name is that file.
PathAndRate lineIn(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || std::filesystem::exists(text)) return {text};
  const std::string word = text.substr(at + 1);
  const std::optional<double> baud = parseNumber(word);
  if (!baud || !(*baud >= 1 && *baud <= 1e8) || *baud != std::floor(*baud))
    throw Error(text + ": '" + word + "' is no rate of a serial line: write bits a second after @");
  return {text.substr(0, at), static_cast<unsigned>(*baud)};
}

// Byte stream of a pipe or a serial device.
class ByteStream : public ProbeSource {
 public:
  bool read(std::vector<ProbeSample>& into, std::vector<RateSample>* rates) override {
    for (const std::size_t before = into.size(); into.size() == before;) {
      pollfd wait[] = {{file_.get(), POLLIN, 0}, {wake_.get(), POLLIN, 0}};
      const int ready = ::poll(wait, 2, longest_wait_);
      if (ready < 0) {
        if (errno == EINTR) continue;
        throw FileError(path_, 0, "cannot be waited for: " + reason(errno));
      }
      if (wait[1].revents) return false;
      if (ready == 0) throw FileError(path_, 0, "the probe has sent nothing for 2 s: is it on?");
      char bytes[4096];
      const ssize_t got = ::read(file_.get(), bytes, sizeof bytes);
      if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (got < 0 && errno != EIO) // a terminal's error when the other side hangs up
        throw FileError(path_, 0, "cannot be read: " + reason(errno));
      if (got <= 0) {
        // A pipe may end, a device may not.
        if (is_serial_)
          throw FileError(path_, 0, "the probe is gone: it was pulled out or hung up");
        end();
        return false;
      }
      take({bytes, static_cast<std::size_t>(got)}, into, rates);
    }
    return true;
  }
  bool isLive() const override { return true; }
  void stop() noexcept override {
    const std::uint64_t one = 1;
    (void)!::write(wake_.get(), &one, sizeof one);
  }

 protected:
  // Opens without blocking, which a pipe without a writer would do.
  ByteStream(const PathAndRate& line, int longest_wait)
      : path_(line.path), longest_wait_(longest_wait),
        file_(openRetrying(path_.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY)),
        wake_(::eventfd(0, EFD_NONBLOCK)) {
    if (file_.get() < 0) throw FileError(path_, 0, "cannot be opened: " + remedy(errno));
    if (wake_.get() < 0) throw FileError(path_, 0, "cannot be waited for: " + reason(errno));
    if (std::filesystem::is_directory(path_)) throw FileError(path_, 0, "is a folder");
    if (termios serial{}; ::tcgetattr(file_.get(), &serial) == 0) {
      is_serial_ = true;
      ::cfmakeraw(&serial); // raw mode, without echo and conversions
      if (line.baud) setRate(serial, *line.baud);
      ::tcsetattr(file_.get(), TCSANOW, &serial);
      // Bytes that arrived earlier have no valid arrival time.
      ::tcflush(file_.get(), TCIFLUSH);
    } else if (line.baud) {
      throw FileError(path_, 0, "is no serial line: leave out @" + std::to_string(*line.baud));
    }
  }
  virtual void take(std::string_view bytes, std::vector<ProbeSample>& into,
                    std::vector<RateSample>* rates) = 0;
  virtual void end() const = 0;
  bool isSerial() const { return is_serial_; }

  const std::string path_;

 private:
  void setRate(termios& serial, unsigned baud) const {
    // The C library turns a number into its constant and refuses one that has none.
    if (::cfsetspeed(&serial, baud) != 0)
      throw FileError(path_, 0,
                      std::to_string(baud) +
                          " is no rate of serial lines: those are 9600, 19200, 38400, 57600, "
                          "115200, 230400, 460800, 500000, 576000, 921600, 1000000, 1500000, "
                          "2000000, 3000000 and 4000000");
  }
  static std::string remedy(int code) {
    if (code == EACCES)
      return reason(code) + ": 'patina devices --install-udev' as root allows probes, "
                            "or join the group dialout";
    return code == EBUSY ? "another program has it: close that program" : reason(code);
  }

  const int longest_wait_; // [ms]; -1: unlimited
  Descriptor file_, wake_;
  bool is_serial_ = false;
};

class ProbeStream final : public ByteStream {
 public:
  explicit ProbeStream(const PathAndRate& line) : ByteStream(line, -1), lines_(line.path) {
    if (isSerial()) lines_.skipPartialLine(); // the first line may be incomplete
  }
  std::string leftOut() const override { return lines_.leftOut(); }

 private:
  void take(std::string_view bytes, std::vector<ProbeSample>& into,
            std::vector<RateSample>* rates) override {
    lines_.take(bytes, into, rates);
  }
  void end() const override { lines_.end(); }

  ProbeLines lines_;
};

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class SerialProbe final : public ByteStream {
 public:
  explicit SerialProbe(const PathAndRate& line) : ByteStream(line, 2000) {}
  std::optional<ProbeHealth> health() const override { return decoder_.health(); }

 private:
  static constexpr std::size_t kForeign = 8192; // longest run of bytes without a packet

  void take(std::string_view bytes, std::vector<ProbeSample>& into,
            std::vector<RateSample>* rates) override {
    const double now = steadySeconds();
    frames_.take(std::as_bytes(std::span(bytes)),
                 [&](ProbePacket packet) { decoder_.take(packet, now, into, rates); });
    came_ += decoder_.health().packets == 0 ? bytes.size() : 0;
    if (came_ > kForeign)
      throw FileError(path_, 0,
                      "what it sends are no packets of a probe: for lines of text say stream:" +
                          path_);
  }
  void end() const override {}

  ProbeFrames frames_;
  ProbeDecoder decoder_;
  std::size_t came_ = 0;
};

// Opens the first probe on the bus, or the one with this serial number.
std::unique_ptr<ProbeSource> openUsbProbe(const std::string& serial) {
  std::string others;
  for (const UsbDevice& device : listUsbDevices()) {
    if (device.haptic != kProbeName) continue;
    if (serial.empty() || device.serial == serial)
      return makeUsbProbe(openUsb(device), device.serial.empty() ? device.name : device.serial,
                          steadySeconds);
    others += (others.empty() ? "" : ", ") + device.serial;
  }
  if (others.empty()) throw DeviceError("there is no probe on the USB bus: plug it in");
  throw DeviceError("there is no probe " + serial + " on the USB bus, only " + others);
}

} // namespace

std::unique_ptr<ProbeSource> openProbe(const std::string& probe) {
  if (probe.starts_with("stream:")) return std::make_unique<ProbeStream>(lineIn(probe.substr(7)));
  if (probe.starts_with("serial:")) return std::make_unique<SerialProbe>(lineIn(probe.substr(7)));
  if (probe.starts_with("usb:")) return openUsbProbe(probe.substr(4));
  if (probe.starts_with("replay:")) return std::make_unique<ReplayedProbe>(probe.substr(7));
  return std::make_unique<ProbeFile>(probe);
}

} // namespace patina
