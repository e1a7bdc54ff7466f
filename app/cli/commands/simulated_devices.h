// What simulate-device makes, each in a source of its own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/cli/output/console.h"
#include "app/cli/output/report.h"
#include "usb/usb_library.h"
#ifdef PATINA_HAS_ACQUISITION
#include "acquisition/simulation/emulated_probe.h"
#endif

namespace patina::cli {

struct SimulatedUsbSpec {
  bool cap = false;                 // a SpaceMouse; else a Falcon
  std::filesystem::path bus{};      // the folder; empty: one of its own, which goes with it
  std::filesystem::path firmware{}; // that its boot loader takes; empty: it runs already
  std::optional<double> unplug{}; // [s], after which it is pulled out for half a second, each time
  std::optional<UsbRefusal> refusal{};
};
// Until Ctrl-C, or for so long [s]. Throws FileError where the folder cannot have a bus.
void simulateUsb(const SimulatedUsbSpec& spec, const std::optional<double>& seconds,
                 Console& console, Report& report);
#ifdef PATINA_HAS_ACQUISITION
void simulateProbe(const EmulatedProbeSpec& spec, const std::filesystem::path& link,
                   const std::optional<double>& seconds, Console& console, Report& report);
#endif

} // namespace patina::cli
