#include <atomic>
#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <sys/eventfd.h>
#include <termios.h>
#include <unistd.h>

#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_files.h"
#include "acquisition/sources/pace.h"
#include "acquisition/sources/probe_decoder.h"
#include "acquisition/sources/sources.h"
#include "acquisition/sources/usb_probe.h"
#include "core/descriptor.h"
#include "core/error.h"
#include "usb/usb_bus.h"

namespace patina {
namespace {

class ProbeFile : public ProbeSource {
 public:
  ProbeFile(const std::string& path) : samples_(readProbeStream(path, &warnings_).values) {}
  bool read(std::vector<ProbeSample>& into) override {
    if (stopped_ || samples_.empty()) return false;
    into.insert(into.end(), samples_.begin(), samples_.end());
    samples_.clear();
    return true;
  }
  bool isLive() const override { return false; }
  void stop() noexcept override { stopped_ = true; }
  std::string leftOut() const override { return warnings_.empty() ? "" : warnings_[0]; }

 private:
  std::vector<std::string> warnings_;
  std::vector<ProbeSample> samples_;
  std::atomic<bool> stopped_{false};
};

class ReplayedProbe : public ProbeSource {
 public:
  ReplayedProbe(const std::string& folder)
      : samples_(readProbeStream(std::filesystem::path(folder) / "probe.csv").values) {
    start_ = samples_[0].t;
    if (std::filesystem::exists(std::filesystem::path(folder) / "frames.csv"))
      start_ = std::min(start_, framesOf(folder, 0)[0].t);
  }
  bool read(std::vector<ProbeSample>& into) override {
    pace_.now();
    if (at_ == samples_.size() || !pace_.waitUntil(samples_[at_].t - start_)) return false;
    for (const double now = pace_.now(); at_ < samples_.size() && samples_[at_].t - start_ <= now;)
      into.push_back(samples_[at_++]);
    return true;
  }
  bool isLive() const override { return true; }
  void stop() noexcept override { pace_.stop(); }

 private:
  std::vector<ProbeSample> samples_;
  double start_ = 0;
  std::size_t at_ = 0;
  Pace pace_;
};

// Bytes as they come from a pipe or a serial device.
class ByteStream : public ProbeSource {
 public:
  bool read(std::vector<ProbeSample>& into) override {
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
      if (got < 0 && errno != EIO) // what a terminal says whose other side is gone
        throw FileError(path_, 0, "cannot be read: " + reason(errno));
      if (got <= 0) {
        // A device has no last line: its end is a fault, where a pipe's is not.
        if (is_serial_)
          throw FileError(path_, 0, "the probe is gone: it was pulled out or hung up");
        end();
        return false;
      }
      take({bytes, static_cast<std::size_t>(got)}, into);
    }
    return true;
  }
  bool isLive() const override { return true; }
  void stop() noexcept override {
    const std::uint64_t one = 1;
    (void)!::write(wake_.get(), &one, sizeof one);
  }

 protected:
  // Not blocking, as a pipe without a writer would.
  ByteStream(const std::string& path, int longest_wait)
      : path_(path), longest_wait_(longest_wait),
        file_(openRetrying(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY)),
        wake_(::eventfd(0, EFD_NONBLOCK)) {
    if (file_.get() < 0) throw FileError(path, 0, "cannot be opened: " + remedy(errno));
    if (wake_.get() < 0) throw FileError(path, 0, "cannot be waited for: " + reason(errno));
    if (std::filesystem::is_directory(path)) throw FileError(path, 0, "is a folder");
    if (termios serial{}; ::tcgetattr(file_.get(), &serial) == 0) {
      is_serial_ = true;
      ::cfmakeraw(&serial); // a terminal would echo what comes and change its bytes
      ::tcsetattr(file_.get(), TCSANOW, &serial);
      // What has lain there since before is no sample of now: it would be taken all at once.
      ::tcflush(file_.get(), TCIFLUSH);
    }
  }
  virtual void take(std::string_view bytes, std::vector<ProbeSample>& into) = 0;
  virtual void end() const = 0;
  bool isSerial() const { return is_serial_; }

  const std::string path_;

 private:
  static std::string remedy(int code) {
    if (code == EACCES)
      return reason(code) + ": 'patina devices --install-udev' as root allows probes, "
                            "or join the group dialout";
    return code == EBUSY ? "another program has it: close that program" : reason(code);
  }

  const int longest_wait_; // [ms]; -1: for ever
  Descriptor file_, wake_;
  bool is_serial_ = false;
};

class ProbeStream final : public ByteStream {
 public:
  explicit ProbeStream(const std::string& path) : ByteStream(path, -1), lines_(path) {
    if (isSerial()) lines_.skipFirst(); // the device may have begun before
  }
  std::string leftOut() const override { return lines_.leftOut(); }

 private:
  void take(std::string_view bytes, std::vector<ProbeSample>& into) override {
    lines_.take(bytes, into);
  }
  void end() const override { lines_.end(); }

  ProbeLines lines_;
};

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class SerialProbe final : public ByteStream {
 public:
  explicit SerialProbe(const std::string& path) : ByteStream(path, 2000) {}
  std::optional<ProbeHealth> health() const override { return decoder_.health(); }

 private:
  static constexpr std::size_t kForeign = 8192; // bytes without a packet

  void take(std::string_view bytes, std::vector<ProbeSample>& into) override {
    const double now = steadySeconds();
    frames_.take(std::as_bytes(std::span(bytes)),
                 [&](ProbePacket packet) { decoder_.take(packet, now, into); });
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

// The first probe on the bus, or the one of this serial number.
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
  if (probe.starts_with("stream:")) return std::make_unique<ProbeStream>(probe.substr(7));
  if (probe.starts_with("serial:")) return std::make_unique<SerialProbe>(probe.substr(7));
  if (probe.starts_with("usb:")) return openUsbProbe(probe.substr(4));
  if (probe.starts_with("replay:")) return std::make_unique<ReplayedProbe>(probe.substr(7));
  return std::make_unique<ProbeFile>(probe);
}

} // namespace patina
