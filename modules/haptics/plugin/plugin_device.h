// Device driven by a plug-in, whose faults cannot stop the loop.
#pragma once

#include <memory>
#include <string>

#include "haptics/link/linked_device.h"
#include "haptics/plugin/patina_device.h"

namespace patina {

// Longest exchange [s]; a longer one is a fault, because its force belonged to another position.
inline constexpr double kMaxPluginTime = 4e-3;

// Opens, exchanges and closes in the link's thread, below the servo's priority. An invalid reply
// (error, non-finite number, position beyond 10 m, no orientation, late) is a fault of that
// exchange; a plug-in that throws is not called again. `plugin` must outlive the link.
std::unique_ptr<DeviceLink> makePluginLink(const patina_device& plugin, std::string argument);

// Opens "plugin:NAME" or "plugin:NAME:ARGUMENT" with a guard from the plug-in's workspace and
// force. Throws Error, and DeviceError if the plug-in is missing or unusable.
std::unique_ptr<Device> makePluginDevice(std::string_view device, LinkedSpec spec = {});

} // namespace patina
