// Catalogue of all devices, for the window, scenes and commands.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "haptics/device/device_limits.h"
#include "haptics/device/device_mount.h"
#include "haptics/device/tip_target.h"
#include "haptics/link/link_statistics.h"
#include "haptics/servo/feel.h"
#include "scene/device_model.h"

namespace patina {

// Parameters for opening; each device uses its part.
struct DeviceSetup {
  std::string name{}; // name in the scene, for devices that need more than their entry
  std::shared_ptr<const TipTarget> target{}; // for pointer-driven devices
  DeviceModel model{};                       // for simulated devices
  std::vector<TimedTip> path{};              // for replays
  // Statistics that a threaded device writes.
  std::shared_ptr<LinkStatistics> notes = std::make_shared<LinkStatistics>();
};

struct DeviceEntry {
  const char* name;    // name in scenes and commands
  const char* caption; // name for the user
  const char* note;    // one line: description and limits
  // The makers' name on the bus (usb_bus.h); empty: built in.
  std::string_view usb{};
  bool selectable = true; // false: a scene does not contain enough to open it
  bool linked = false;    // has its own thread and writes the setup's statistics
  // True if it takes the scene's device.* values and is reopened when they change.
  bool uses_device_model = false;
  double hand_compliance = 0; // compliance of a simulated hand [m/N]
  DeviceModel model{};        // defaults for a scene without values
  DeviceLimits limits{};
  std::unique_ptr<Device> (*open)(const DeviceSetup&); // throws DeviceError
};

std::span<const DeviceEntry> deviceCatalog();
// Finds a device that scenes may name, or a plug-in. Throws Error with the list of names.
const DeviceEntry& deviceNamed(std::string_view name);

// Mount that places the centre of the device's workspace, if it has one, at `place` in the world.
MountSpec mountAt(const DeviceEntry& entry, const Vec3& place);

// Opens and mounts a device, with the force limited to its maximum. Throws DeviceError, and
// std::invalid_argument if the setup lacks a required part.
std::unique_ptr<Device>
openDevice(const DeviceEntry& entry, const DeviceSetup& setup, MountSpec mount = {},
           std::shared_ptr<const MountControls> controls = std::make_shared<const MountControls>());

} // namespace patina
