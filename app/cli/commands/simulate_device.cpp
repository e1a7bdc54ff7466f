#include "app/cli/commands/commands.h"
#include "app/cli/commands/simulated_devices.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina::cli {

namespace {

struct SimulateDeviceOptions {
  std::string device;
#ifdef PATINA_HAS_ACQUISITION
  EmulatedProbeSpec probe;
  std::filesystem::path link;
#endif
  SimulatedUsbSpec usb;
  std::optional<double> seconds;
};

const Keys kSimulateDeviceKeys = {
    {"port", "", "port", "of a probe, as packets, lost, spoilt and unread", Shown::if_any},
    {"bus", "", "bus", "of the others, as claims, unpluggings and frames", Shown::if_any},
    {"seconds", "s", "ran"},
    {"packets", "", "packets", "of samples, made", Shown::if_any},
    {"lost", "", "lost", "of them, on purpose", Shown::if_any},
    {"spoilt", "", "spoilt", "of them, on purpose", Shown::if_any},
    {"unread", "", "unread", "frames that nobody took in time", Shown::if_any},
    {"claims", "", "claims", "times that a program took its interface", Shown::if_any},
    {"unpluggings", "", "unpluggings", "", Shown::if_any},
    {"frames", "", "frames", "that came to a Falcon", Shown::if_any}};

int runSimulateDevice(const SimulateDeviceOptions& options, Console& console) {
  Report report(kSimulateDeviceKeys);
  if (options.device == "probe")
    console.warnOfNoEffect({"--bus", "--unplug", "--firmware", "--refuse"}, "on a probe");
  else
    console.warnOfNoEffect(
        {"--rate", "--together", "--loss", "--corrupt", "--skew", "--link", "--seed"},
        "on a " + options.device);
  if (options.device == "spacemouse") console.warnOfNoEffect({"--firmware"}, "on a spacemouse");
#ifdef PATINA_HAS_ACQUISITION
  if (options.device == "probe")
    simulateProbe(options.probe, options.link, options.seconds, console, report);
  else
#endif
    simulateUsb(options.usb, options.seconds, console, report);
  return console.report(report);
}

} // namespace

Command simulateDeviceCommand() {
  auto options = std::make_shared<SimulateDeviceOptions>();
  Command command{
      .name = "simulate-device",
      .summary = "a Falcon, a SpaceMouse or a probe, without one",
      .description =
          "DEVICE is falcon, spacemouse or probe. A probe opens a pseudo-terminal, says its name, "
          "and sends the packets of docs/usb_protocol.md in real time, whether anyone reads or "
          "not. What it presses is a force that comes and goes twice a second. It can lose and "
          "spoil packets and have a clock that is wrong, to see what a program makes of that.\n"
          "The others stand on a USB bus that is a folder. A program sees it that runs under "
          "usbfs_shim.so, a library of the tests' build that answers what libusb asks of the "
          "kernel: LD_PRELOAD=build/bin/usbfs_shim.so PATINA_USBFS=DIR patina devices --diagnose. "
          "A hand draws circles with the Falcon's handle, and sways the SpaceMouse's cap.\n"
          "It ends with Ctrl-C or after --seconds.",
      .examples = {"patina simulate-device probe --rate 4000 --loss 0.001 --skew 80",
                   "patina simulate-device falcon --bus /tmp/bus --unplug 5"},
      .keys = kSimulateDeviceKeys,
      .arguments =
          {input("DEVICE", "falcon, spacemouse or probe.",
                 [options](const std::string& word) {
#ifdef PATINA_HAS_ACQUISITION
                   const bool known = word == "probe" || word == "falcon" || word == "spacemouse";
#else
                   const bool known = word == "falcon" || word == "spacemouse";
#endif
                   if (!known)
                     throw Error("DEVICE = " + word + ": it must be falcon, spacemouse or probe");
                   options->device = word;
                   options->usb.cap = word == "spacemouse";
                 }),
           {"--seconds", "S", "s", "", "How long.",
            inRange(1e-3, 1e6, [options](double s) { options->seconds = s; })},
           {"--bus", "DIR", "", "", "Of falcon and spacemouse: the bus's folder. [a new one]",
            outInto(options->usb.bus)},
           {"--unplug", "S", "s", "",
            "Of falcon and spacemouse: pulled out for half a second after each S.",
            inRange(0.01, 1e6, [options](double s) { options->usb.unplug = s; })},
           {"--firmware", "FILE", "", "",
            "Of falcon: what its boot loader takes. [it runs a firmware]",
            into(options->usb.firmware)},
           {"--refuse", "WHAT", "", "",
            "Of falcon and spacemouse: permission (to be opened), claim (another program has it) "
            "or transfers (as behind a hub that has dropped it).",
            [options](const std::string& word) {
              if (word != "permission" && word != "claim" && word != "transfers")
                throw Error("--refuse = " + word + ": it must be permission, claim or transfers");
              options->usb.refusal = word == "permission" ? UsbRefusal::permission
                                     : word == "claim"    ? UsbRefusal::held_by_driver
                                                          : UsbRefusal::other;
            }}},
      .run = [options](Console& console) { return runSimulateDevice(*options, console); }};
#ifdef PATINA_HAS_ACQUISITION
  const auto part = [](double& target) {
    return inRange(0, 1, [&target](double value) { target = value; });
  };
  EmulatedProbeSpec& probe = options->probe;
  const std::vector<Argument> of_probe{
      {"--rate", "HZ", "Hz", "1000", "Samples a second.",
       inRange(1, 10000, [options](double hz) { options->probe.rate = hz; })},
      {"--together", "N", "samples", "4", "In a packet, 1 to 4.",
       inRange(
           1, 4,
           [options](double n) { options->probe.samples_per_packet = static_cast<unsigned>(n); },
           NumberKind::whole)},
      {"--loss", "PART", "", "0", "Of the packets that are lost, 0 to 1.", part(probe.loss)},
      {"--corrupt", "PART", "", "0", "Of the packets that are spoilt, 0 to 1.",
       part(probe.corrupt)},
      {"--skew", "PPM", "ppm", "0", "By which its clock runs faster.",
       inRange(-5000, 5000, [options](double ppm) { options->probe.skew = 1e-6 * ppm; })},
      {"--link", "FILE", "", "", "A link to the port, while it is there.", outInto(options->link)},
      {"--seed", "N", "", "1", "Of what is lost and spoilt.",
       inRange(
           0, 4294967295.,
           [options](double n) { options->probe.seed = static_cast<std::uint32_t>(n); },
           NumberKind::whole)}};
  command.arguments.insert(command.arguments.end(), of_probe.begin(), of_probe.end());
#endif
  return command;
}

} // namespace patina::cli
