#include "haptics/devices/device_catalog.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "haptics/devices/emulated_devices.h"
#include "haptics/devices/falcon/falcon_device.h"
#include "haptics/devices/plugin/plugin_device.h"
#include "haptics/devices/plugin/plugin_library.h"
#include "haptics/devices/replayed_hand.h"
#include "haptics/devices/simulated_hand.h"
#include "haptics/devices/spacemouse/spacemouse.h"
#include "usb/usb_bus.h"

namespace patina {
namespace {

constexpr DeviceLimits kNoForce{.max_force = 0, .max_stiffness = 0};
constexpr std::string_view kFalcon = "Novint Falcon", kSpaceMouse = "3Dconnexion SpaceMouse";

const DeviceLimits kFalconLimits{.workspace = kFalconWorkspace,
                                 .max_force = falconGuard().max_force};
// Of handle and hand together, as they are emulated; the maker states none of them.
constexpr DeviceModel kFalconModel{.mass = 0.25, .damping = 3, .encoder_step = 4e-5, .delay = 1};

std::unique_ptr<Device> openFalcon(const DeviceSetup& setup) {
  const LinkedSpec spec{.guard = falconGuard(), .notes = setup.notes};
  return makeLinkedDevice(makeFalconLink(usbOpener(kFalcon), falconFirmwareSource(), spec.clock),
                          spec);
}

std::unique_ptr<Device> openSpaceMouse(const DeviceSetup& setup) {
  const LinkedSpec spec{.notes = setup.notes};
  const GlidingTip tip(setup.target);
  return makeLinkedDevice(
      makeSpaceMouseLink(usbOpener(kSpaceMouse), {.start = tip.position()}, spec.clock), spec);
}

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
    {.name = "falcon",
     .caption = "Novint Falcon",
     .note = "three motors on a delta robot; its firmware is a file of its maker's, named by "
             "PATINA_FALCON_FIRMWARE",
     .usb = kFalcon,
     .linked = true,
     .model = kFalconModel,
     .limits = kFalconLimits,
     .open = &openFalcon},
    {.name = "spacemouse",
     .caption = "SpaceMouse",
     .note = "seen, not felt: the tip moves as fast as the cap is pushed",
     .usb = kSpaceMouse,
     .linked = true,
     .limits = kNoForce,
     .open = &openSpaceMouse},
    {.name = "sim:falcon",
     .caption = "Emulated Falcon",
     .note = "the Falcon's driver over an emulated wire, its handle led by the pointer",
     .linked = true,
     .model = kFalconModel,
     .limits = kFalconLimits,
     .open =
         [](const DeviceSetup& setup) { return makeEmulatedFalcon(setup.target, setup.notes); }},
    {.name = "sim:spacemouse",
     .caption = "Emulated SpaceMouse",
     .note = "the SpaceMouse's driver over an emulated wire, its cap led by the pointer",
     .linked = true,
     .limits = kNoForce,
     .open =
         [](const DeviceSetup& setup) {
           return makeEmulatedSpaceMouse(setup.target, setup.notes);
         }},
    {.name = "replay",
     .caption = "Replayed hand",
     .note = "plays a recorded tip path",
     .in_scenes = false,
     .limits = kNoForce,
     .open = [](const DeviceSetup& setup) { return makeReplayedHand(setup.path); }},
};

// Not in the list, as each of its kind has a name of its own.
const DeviceEntry kPlugin{.name = "plugin",
                          .caption = "Plug-in",
                          .note = "a library of its maker's drives it",
                          .linked = true,
                          .open = [](const DeviceSetup& setup) {
                            return makePluginDevice(setup.name, {.notes = setup.notes});
                          }};

} // namespace

std::span<const DeviceEntry> deviceCatalog() {
  return kCatalog;
}

const DeviceEntry& deviceNamed(std::string_view name) {
  if (isPlugin(name)) return (void)pluginName(name), kPlugin;
  std::string known;
  for (const DeviceEntry& entry : kCatalog) {
    if (!entry.in_scenes) continue;
    if (entry.name == name) return entry;
    known += (known.empty() ? "" : " or ") + std::string(entry.name);
  }
  throw Error("device = " + std::string(name) + ": it must be " + known + " or plugin:NAME");
}

MountSpec mountAt(const DeviceEntry& entry, const Vec3& place) {
  MountSpec mount;
  if (entry.limits.workspace) mount.world_from_device.translation() = place;
  return mount;
}

std::unique_ptr<Device> openDevice(const DeviceEntry& entry, const DeviceSetup& setup,
                                   MountSpec mount, std::shared_ptr<const MountControls> controls) {
  if (entry.limits.max_force.value_or(0) > 0)
    mount.max_force = std::min(mount.max_force, *entry.limits.max_force);
  return mountDevice(entry.open(setup), mount, std::move(controls));
}

} // namespace patina
