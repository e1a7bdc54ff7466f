// The one list of devices: the window, scenes and commands ask it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "haptics/devices/device_mount.h"
#include "haptics/devices/link/link_notes.h"
#include "haptics/devices/tip_target.h"
#include "haptics/servo/feel.h"
#include "scene/device_model.h"

namespace patina {

// Absent where nobody knows, or where there is none.
struct DeviceLimits {
  std::optional<Box3> workspace{};       // [m], device frame
  std::optional<double> max_force{};     // [N]; 0: it renders none
  std::optional<double> max_stiffness{}; // [N/m], that it can display
};

// What opening needs; each device takes its part.
struct DeviceSetup {
  std::string name{}; // as the scene has it, of what needs more than its entry
  std::shared_ptr<const TipTarget> target{}; // of what a pointer moves
  DeviceModel model{};                       // of what is simulated
  std::vector<TimedTip> path{};              // of what is replayed
  // What a device with a thread of its own tells of itself.
  std::shared_ptr<LinkNotes> notes = std::make_shared<LinkNotes>();
};

struct DeviceEntry {
  const char* name;    // as in scenes and commands
  const char* caption; // for a person
  const char* note;    // one line: what it is, what is felt
  // Makers' name of it on the bus (usb_bus.h); empty: built in.
  std::string_view usb{};
  bool in_scenes = true;      // false: it needs more than a scene holds
  bool linked = false;        // has a thread of its own, and tells DeviceSetup::notes
  bool takes_numbers = false; // the scene's device.* are its own, and it is opened anew with them
  double hand_compliance = 0; // [m/N], of a simulated hand that holds it
  DeviceModel model{};        // where a scene has no numbers
  DeviceLimits limits{};
  std::unique_ptr<Device> (*open)(const DeviceSetup&); // throws DeviceError
};

std::span<const DeviceEntry> deviceCatalog();
// Of those that a scene may name, plug-ins too (plugin/plugin_library.h). Throws Error that lists
// them.
const DeviceEntry& deviceNamed(std::string_view name);

// Where the middle of the device's own workspace, if it has one, lies in the world.
MountSpec mountAt(const DeviceEntry& entry, const Vec3& place);

// Mounted, its force held to what the device renders. Throws DeviceError, and
// std::invalid_argument where the setup lacks what the device takes.
std::unique_ptr<Device>
openDevice(const DeviceEntry& entry, const DeviceSetup& setup, MountSpec mount = {},
           std::shared_ptr<const MountControls> controls = std::make_shared<const MountControls>());

} // namespace patina
