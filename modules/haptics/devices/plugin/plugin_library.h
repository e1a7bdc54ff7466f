// The libraries of devices that are no part of Patina: found by name, judged before they are used.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "haptics/devices/device_catalog.h"
#include "haptics/devices/plugin/patina_device.h"

namespace patina {

// "plugin:NAME" or "plugin:NAME:ARGUMENT", as a scene names it. A NAME is letters, digits, '-' and
// '_', so that a scene from elsewhere can only name what is installed here.
struct PluginName {
  std::string name, argument;
};
bool isPlugin(std::string_view device);         // begins with "plugin:"
PluginName pluginName(std::string_view device); // throws Error

// Looked for in the folders of PATINA_DEVICES (a list with ':'), beside the program, and where it
// is installed; it stays loaded. Throws DeviceError: none of this name, no plug-in, or of another
// ABI.
const patina_device& loadedPlugin(const std::string& name);

struct PluginFound {
  std::string name, caption{}, note{};
  DeviceLimits limits{};
  std::string problem{}; // why it cannot be used; then the others are empty
};
std::vector<PluginFound> installedPlugins(); // by name; loads each

// No force above what it renders, none out of its workspace.
GuardSpec guardFor(const DeviceLimits& limits);

// Sound text and numbers, whatever it says of itself.
PluginFound described(const std::string& name, const patina_device& plugin);

} // namespace patina
