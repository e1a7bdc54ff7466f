#include "haptics/devices/device_catalog.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "haptics/devices/replayed_hand.h"
#include "haptics/devices/simulated_hand.h"

namespace patina {
namespace {

constexpr DeviceLimits kNoForce{.max_force = 0, .max_stiffness = 0};

// A row a device; the order is the one that a person is shown.
const DeviceEntry kCatalog[] = {
    {.name = "mouse",
     .caption = "Mouse",
     .note = "seen, not felt: the tip is where it is told to be, the drawn tool is held out by the "
             "contact",
     .limits = kNoForce,
     .open = [](const DeviceSetup& setup) { return makeMouse(setup.target); }},
    {.name = "simulated",
     .caption = "Simulated device",
     .note = "a mass in a hand, moved exactly: it yields, and rests where the forces are equal",
     .takes_numbers = true,
     .hand_compliance = 1 / HandSpec{}.stiffness,
     .open =
         [](const DeviceSetup& setup) {
           return makeSimulatedHand(setup.target, HandSpec{.device = setup.model});
         }},
    {.name = "replay",
     .caption = "Replayed hand",
     .note = "plays a recorded tip path",
     .in_scenes = false,
     .limits = kNoForce,
     .open = [](const DeviceSetup& setup) { return makeReplayedHand(setup.path); }},
};

} // namespace

std::span<const DeviceEntry> deviceCatalog() {
  return kCatalog;
}

const DeviceEntry& deviceNamed(std::string_view name) {
  std::string known;
  for (const DeviceEntry& entry : kCatalog) {
    if (!entry.in_scenes) continue;
    if (entry.name == name) return entry;
    known += (known.empty() ? "" : " or ") + std::string(entry.name);
  }
  throw Error("device = " + std::string(name) + ": it must be " + known);
}

std::unique_ptr<Device> openDevice(const DeviceEntry& entry, const DeviceSetup& setup,
                                   MountSpec mount, std::shared_ptr<const MountControls> controls) {
  if (entry.limits.max_force.value_or(0) > 0)
    mount.max_force = std::min(mount.max_force, *entry.limits.max_force);
  return mountDevice(entry.open(setup), mount, std::move(controls));
}

} // namespace patina
