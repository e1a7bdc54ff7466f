// A probe on a pseudo-terminal.
#include <array>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <termios.h>
#include <thread>
#include <unistd.h>

#include "app/cli/commands/simulated_devices.h"
#include "core/descriptor.h"
#include "core/error.h"
#include "core/unfinished.h"

namespace patina::cli {

namespace {

// A terminal's two ends: what is written into `ours` is read from the port.
struct Port {
  Port() : ours(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)), theirs(-1) {
    if (ours.get() < 0 || ::grantpt(ours.get()) != 0 || ::unlockpt(ours.get()) != 0)
      throw DeviceError("no pseudo-terminal can be opened: " + reason(errno));
    path = ::ptsname(ours.get());
    // Kept open, so that a reader that comes and goes is no hang-up; and no echo.
    theirs.reset(openRetrying(path.c_str(), O_RDWR | O_NOCTTY));
    termios raw{};
    if (::tcgetattr(theirs.get(), &raw) != 0)
      throw DeviceError(path + " cannot be set up: " + reason(errno));
    ::cfmakeraw(&raw);
    ::tcsetattr(theirs.get(), TCSANOW, &raw);
  }
  // Whole frames. What a reader does not take in time waits here, as it would in the kernel.
  bool send(std::span<const std::uint8_t> frame) {
    const bool fits = rest.size() + frame.size() <= kBuffer;
    if (fits) rest.insert(rest.end(), frame.begin(), frame.end());
    flush();
    return fits;
  }
  void flush() {
    const ssize_t wrote = rest.empty() ? 0 : ::write(ours.get(), rest.data(), rest.size());
    if (wrote > 0) rest.erase(rest.begin(), rest.begin() + wrote);
  }
  static constexpr std::size_t kBuffer = 65536; // bytes
  Descriptor ours, theirs;
  std::string path;
  std::vector<std::uint8_t> rest;
};

// A name for the port that a script can know beforehand; gone with this.
struct Link {
  Link(const std::filesystem::path& link, const std::string& to) : path(link) {
    if (path.empty()) return;
    std::error_code failed;
    std::filesystem::create_symlink(to, path, failed);
    if (failed) throw FileError(path.string(), 0, "cannot be made: " + failed.message());
    unfinished = Unfinished(path);
  }
  ~Link() {
    std::error_code ignored;
    if (!path.empty()) std::filesystem::remove(path, ignored);
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  std::filesystem::path path;
  Unfinished unfinished; // gone, too, where Ctrl-C ends what does not end
};

} // namespace

void simulateProbe(const EmulatedProbeSpec& spec, const std::filesystem::path& link_at,
                   const std::optional<double>& seconds, Console& console, Report& report) {
  Port port;
  EmulatedProbe probe(spec);
  const Link link(link_at, port.path);
  console.say("a probe on " + port.path + "; record it with --probe serial:" + port.path);
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  std::size_t unread = 0;
  double now = 0;
  while (!console.progress().cancelled() && !(seconds && now >= *seconds)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    now = std::chrono::duration<double>(Clock::now() - begin).count();
    if (seconds) now = std::min(now, *seconds);
    probe.until(now, [&](ProbePacket packet, double) {
      std::array<std::uint8_t, PROBE_FRAME> frame;
      probe_frame(reinterpret_cast<const std::uint8_t*>(packet.data()), frame.data());
      unread += !port.send(frame);
    });
  }
  report.set("port", port.path).set("seconds", now).set("packets", probe.made());
  report.set("lost", probe.lost()).set("spoilt", probe.spoilt()).set("unread", unread);
}

} // namespace patina::cli
