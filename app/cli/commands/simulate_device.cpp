// Simulates a probe on a pseudo-terminal.
#include <array>
#include <cerrno>
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
#include "core/partial_output.h"

namespace patina::cli {

namespace {

struct SimulateDeviceOptions {
  EmulatedProbeSpec probe;
  std::filesystem::path link;
  std::optional<double> seconds;
};

const Keys kSimulateDeviceKeys = {
    {"port", "", "port"},
    {"seconds", "s", "ran"},
    {"packets", "", "packets", "of samples, made", Shown::if_any},
    {"lost", "", "lost", "of them, on purpose", Shown::if_any},
    {"spoilt", "", "corrupted", "of them, on purpose", Shown::if_any},
    {"unread", "", "unread", "frames that were not read in time", Shown::if_any}};

// A pseudo-terminal: data written to `ours` is read from the port.
struct Port {
  Port() : ours(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)), theirs(-1) {
    if (ours.get() < 0 || ::grantpt(ours.get()) != 0 || ::unlockpt(ours.get()) != 0)
      throw DeviceError("no pseudo-terminal can be opened: " + reason(errno));
    path = ::ptsname(ours.get());
    // Kept open, so that a reader can come and go without a hang-up; echo is off.
    theirs.reset(openRetrying(path.c_str(), O_RDWR | O_NOCTTY));
    termios raw{};
    if (::tcgetattr(theirs.get(), &raw) != 0)
      throw DeviceError(path + " cannot be set up: " + reason(errno));
    ::cfmakeraw(&raw);
    ::tcsetattr(theirs.get(), TCSANOW, &raw);
  }
  // Sends whole frames. Unread frames wait here, as in a kernel's buffer.
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

// Symbolic link with a fixed name for the port; the destructor removes it.
struct Link {
  Link(const std::filesystem::path& link, const std::string& to) : path(link) {
    if (path.empty()) return;
    std::error_code failed;
    std::filesystem::create_symlink(to, path, failed);
    if (failed) throw FileError(path.string(), 0, "cannot be made: " + failed.message());
    unfinished = PartialOutput(path);
  }
  ~Link() {
    std::error_code ignored;
    if (!path.empty()) std::filesystem::remove(path, ignored);
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  std::filesystem::path path;
  PartialOutput unfinished; // also removed if Ctrl-C ends the process
};

int runSimulateDevice(const SimulateDeviceOptions& options, Console& console) {
  const std::optional<double>& seconds = options.seconds;
  Port port;
  EmulatedProbe probe(options.probe);
  const Link link(options.link, port.path);
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
  Report report(kSimulateDeviceKeys);
  report.set("port", port.path).set("seconds", now).set("packets", probe.made());
  report.set("lost", probe.lost()).set("spoilt", probe.corrupted()).set("unread", unread);
  return console.report(report);
}

} // namespace

Command simulateDeviceCommand() {
  auto options = std::make_shared<SimulateDeviceOptions>();
  EmulatedProbeSpec& probe = options->probe;
  return {
      .name = "simulate-device",
      .summary = "a probe, without one",
      .description =
          "The only DEVICE is probe. It opens a pseudo-terminal, reports its name, and sends the "
          "packets of docs/usb_protocol.md in real time, whether anyone reads or not. Its force "
          "rises and falls twice a second; with a gyroscope it swings about its shaft. It can lose "
          "and corrupt packets and have a wrong clock, "
          "to test a program. It ends with Ctrl-C or after --seconds.",
      .examples = {"patina simulate-device probe --rate 4000 --loss 0.001 --skew 80"},
      .keys = kSimulateDeviceKeys,
      .arguments =
          {input("DEVICE", "probe.",
                 [](const std::string& word) {
                   if (word != "probe") throw Error("DEVICE = " + word + ": it must be probe");
                 }),
           {"--seconds", "S", "s", "", "How long.", numberInto(1e-3, 1e6, options->seconds)},
           {"--rate", "HZ", "Hz", "1000", "Samples a second.", numberInto(1, 10000, probe.rate)},
           {"--samples-per-packet", "N", "samples", "4", "In a packet, 1 to 4.",
            numberInto(1, 4, probe.samples_per_packet, NumberKind::whole)},
           {"--gyroscope", "", "", "", "The probe has one, and at most 2 samples in a packet.",
            into(probe.gyroscope)},
           {"--loss", "PART", "", "0", "Of the packets that are lost, 0 to 1.",
            numberInto(0, 1, probe.loss)},
           {"--corrupt", "PART", "", "0", "Share of corrupted packets, 0 to 1.",
            numberInto(0, 1, probe.corrupt)},
           {"--skew", "PPM", "ppm", "0", "By which its clock runs faster.",
            inRange(-5000, 5000, [options](double ppm) { options->probe.skew = 1e-6 * ppm; })},
           {"--link", "FILE", "", "", "A link to the port, while it is there.",
            outInto(options->link)},
           {"--seed", "N", "", "1", "Seed of the lost and corrupted packets.",
            numberInto(0, 4294967295., probe.seed, NumberKind::whole)}},
      .run = [options](Console& console) { return runSimulateDevice(*options, console); }};
}

} // namespace patina::cli
