#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <termios.h>
#include <thread>
#include <unistd.h>

#include "acquisition/simulation/emulated_probe.h"
#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/descriptor.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina::cli {

namespace {

struct SimulateDeviceOptions {
  std::string device;
  EmulatedProbeSpec probe;
  std::optional<double> seconds;
  std::filesystem::path link;
};

const Keys kSimulateDeviceKeys = {
    {"port", "", "port"},
    {"seconds", "s", "ran"},
    {"packets", "", "packets", "of samples, made"},
    {"lost", "", "lost", "of them, on purpose", Shown::if_any},
    {"spoilt", "", "spoilt", "of them, on purpose", Shown::if_any},
    {"unread", "", "unread", "frames that nobody took in time", Shown::if_any}};

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
  }
  ~Link() {
    std::error_code ignored;
    if (!path.empty()) std::filesystem::remove(path, ignored);
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  std::filesystem::path path;
};

int runSimulateDevice(const SimulateDeviceOptions& options, Console& console) {
  Port port;
  EmulatedProbe probe(options.probe);
  const Link link(options.link, port.path);
  console.warn("a probe on " + port.path + "; record it with --probe serial:" + port.path);
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  std::size_t unread = 0;
  double now = 0;
  while (!console.progress().cancelled() && !(options.seconds && now >= *options.seconds)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    now = std::chrono::duration<double>(Clock::now() - begin).count();
    if (options.seconds) now = std::min(now, *options.seconds);
    probe.until(now, [&](ProbePacket packet, double) {
      std::array<std::uint8_t, PROBE_FRAME> frame;
      probe_frame(reinterpret_cast<const std::uint8_t*>(packet.data()), frame.data());
      unread += !port.send(frame);
    });
  }
  Report report(kSimulateDeviceKeys);
  report.set("port", port.path).set("seconds", now).set("packets", probe.made());
  report.set("lost", probe.lost()).set("spoilt", probe.spoilt()).set("unread", unread);
  console.report(report);
  return kDone;
}

} // namespace

Command simulateDeviceCommand() {
  auto options = std::make_shared<SimulateDeviceOptions>();
  const auto part = [](double& target) {
    return inRange(0, 1, [&target](double value) { target = value; });
  };
  EmulatedProbeSpec& probe = options->probe;
  return {
      .name = "simulate-device",
      .summary = "a probe on a serial port, without a probe",
      .description = "DEVICE is probe: it opens a pseudo-terminal, says its name, and sends the "
                     "packets of docs/usb_protocol.md in real time, until Ctrl-C or for --seconds, "
                     "whether anyone reads or not. What it presses is a force that comes and goes "
                     "twice a second. It can lose and spoil packets and have a clock that is "
                     "wrong, to see what a program makes of that.",
      .examples = {"patina simulate-device probe --rate 4000 --loss 0.001 --skew 80"},
      .keys = kSimulateDeviceKeys,
      .arguments =
          {input("DEVICE", "probe.",
                 [options](const std::string& word) {
                   if (word != "probe") throw Error("DEVICE = " + word + ": it must be probe");
                 }),
           {"--rate", "HZ", "Hz", "1000", "Samples a second.",
            inRange(1, 10000, [options](double hz) { options->probe.rate = hz; })},
           {"--together", "N", "samples", "4", "In a packet, 1 to 4.",
            inRange(
                1, 4,
                [options](double n) {
                  options->probe.samples_per_packet = static_cast<unsigned>(n);
                },
                NumberKind::whole)},
           {"--loss", "PART", "", "0", "Of the packets that are lost, 0 to 1.", part(probe.loss)},
           {"--corrupt", "PART", "", "0", "Of the packets that are spoilt, 0 to 1.",
            part(probe.corrupt)},
           {"--skew", "PPM", "ppm", "0", "By which its clock runs faster.",
            inRange(-5000, 5000, [options](double ppm) { options->probe.skew = 1e-6 * ppm; })},
           {"--seconds", "S", "s", "", "How long.",
            inRange(1e-3, 1e6, [options](double s) { options->seconds = s; })},
           {"--link", "FILE", "", "", "A link to the port, while it is there.",
            into(options->link)},
           {"--seed", "N", "", "1", "Of what is lost and spoilt.",
            inRange(
                0, 4294967295.,
                [options](double n) { options->probe.seed = static_cast<std::uint32_t>(n); },
                NumberKind::whole)}},
      .run = [options](Console& console) { return runSimulateDevice(*options, console); }};
}

} // namespace patina::cli
