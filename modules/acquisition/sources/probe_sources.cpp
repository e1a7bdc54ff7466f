#include <atomic>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <sys/eventfd.h>
#include <termios.h>
#include <unistd.h>

#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_files.h"
#include "acquisition/sources/pace.h"
#include "acquisition/sources/sources.h"
#include "core/descriptor.h"
#include "core/error.h"

namespace patina {
namespace {

class ProbeFile : public ProbeSource {
 public:
  ProbeFile(const std::string& path) : samples_(readProbeStream(path).values) {}
  bool read(std::vector<ProbeSample>& into) override {
    if (stopped_ || samples_.empty()) return false;
    into.insert(into.end(), samples_.begin(), samples_.end());
    samples_.clear();
    return true;
  }
  bool isLive() const override { return false; }
  void stop() noexcept override { stopped_ = true; }

 private:
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

class ProbeStream : public ProbeSource {
 public:
  // Not blocking, as a pipe without a writer would.
  ProbeStream(const std::string& path)
      : path_(path), file_(openRetrying(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY)),
        wake_(::eventfd(0, EFD_NONBLOCK)), lines_(path) {
    if (file_.get() < 0) throw FileError(path, 0, "cannot be opened: " + reason(errno));
    if (wake_.get() < 0) throw FileError(path, 0, "cannot be waited for: " + reason(errno));
    if (std::filesystem::is_directory(path)) throw FileError(path, 0, "is a folder");
    if (termios serial{}; ::tcgetattr(file_.get(), &serial) == 0) {
      is_serial_ = true;
      ::cfmakeraw(&serial); // a terminal would echo what comes and change its bytes
      ::tcsetattr(file_.get(), TCSANOW, &serial);
      // The device may have begun before.
      lines_.skipFirst();
    }
  }
  bool read(std::vector<ProbeSample>& into) override {
    for (;;) {
      pollfd wait[] = {{file_.get(), POLLIN, 0}, {wake_.get(), POLLIN, 0}};
      if (::poll(wait, 2, -1) < 0) {
        if (errno == EINTR) continue;
        throw FileError(path_, 0, "cannot be waited for: " + reason(errno));
      }
      if (wait[1].revents) return false;
      char bytes[4096];
      const ssize_t got = ::read(file_.get(), bytes, sizeof bytes);
      if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (got < 0 && errno != EIO) // what a terminal says whose other side is gone
        throw FileError(path_, 0, "cannot be read: " + reason(errno));
      if (got <= 0) {
        // A device has no last line: its end is a fault, where a pipe's is not.
        if (is_serial_)
          throw FileError(path_, 0, "the probe is gone: it was pulled out or hung up");
        lines_.end();
        return false;
      }
      const std::size_t before = into.size();
      lines_.take({bytes, static_cast<std::size_t>(got)}, into);
      if (into.size() > before) return true;
    }
  }
  bool isLive() const override { return true; }
  void stop() noexcept override {
    const std::uint64_t one = 1;
    (void)!::write(wake_.get(), &one, sizeof one);
  }

 private:
  std::string path_;
  Descriptor file_, wake_;
  bool is_serial_ = false;
  ProbeLines lines_;
};

} // namespace

std::unique_ptr<ProbeSource> openProbe(const std::string& probe) {
  if (probe.starts_with("stream:")) return std::make_unique<ProbeStream>(probe.substr(7));
  if (probe.starts_with("replay:")) return std::make_unique<ReplayedProbe>(probe.substr(7));
  return std::make_unique<ProbeFile>(probe);
}

} // namespace patina
