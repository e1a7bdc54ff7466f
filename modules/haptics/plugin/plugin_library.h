// External device libraries: found by name and checked before use.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "haptics/device/device_limits.h"
#include "haptics/device/device_mount.h"
#include "haptics/link/force_guard.h"
#include "haptics/plugin/patina_device.h"

namespace patina {

// "plugin:NAME" or "plugin:NAME:ARGUMENT", as in a scene. A NAME has letters, digits, '-' and '_'
// only, so that a foreign scene can only refer to installed plug-ins.
struct PluginName {
  std::string name, argument;
};
bool isPlugin(std::string_view device);         // starts with "plugin:"
PluginName pluginName(std::string_view device); // throws Error

// Loads a plug-in for the rest of the process. Searches the folders of PATINA_DEVICES (separated by
// ':'), the program's folder and the installation folder. Before any of its code runs, owners and
// permissions (trustedFile) and the ABI version are checked. Throws DeviceError: not found, not
// trusted, not a plug-in, or another ABI version.
const patina_device& loadedPlugin(const std::string& name);

struct PluginFound {
  std::string name, caption{}, note{};
  DeviceLimits limits{};
  std::string problem{}; // reason why it is unusable; the other texts are then empty
};
std::vector<PluginFound> installedPlugins(); // sorted by name; loads each

// Guard with the device's force limit and workspace.
GuardSpec guardFor(const DeviceLimits& limits);

// Reads the description and replaces unprintable text and invalid numbers.
PluginFound described(const std::string& name, const patina_device& plugin);

} // namespace patina
